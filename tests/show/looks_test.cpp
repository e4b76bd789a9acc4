// Looks of pictures and reports: colours, views, outlines, packed arrays.
#include "show/looks.hpp"

#include <nlohmann/json.hpp>

#include "core/errors.hpp"
#include "measure/cell_columns.hpp"
#include "show/boundary_surface.hpp"
#include "show/report_frames.hpp"
#include "support/frames.hpp"
#include "support/tissues.hpp"

namespace {

// CIE L*, a*, b* of an sRGB colour (white D65), from CIE 15's formulas.
Vec3 lab_of(const Rgb& rgb) {
  Vec3 light;
  for (int i = 0; i < 3; ++i) light[i] = rgb[i] <= 0.04045 ? rgb[i] / 12.92 : std::pow((rgb[i] + 0.055) / 1.055, 2.4);
  Mat3 to_xyz;
  to_xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Vec3 xyz = to_xyz * light, white(0.95047, 1, 1.08883);
  Vec3 f;
  for (int i = 0; i < 3; ++i) {
    const double part = xyz[i] / white[i];
    f[i] = part > 216.0 / 24389 ? std::cbrt(part) : (24389.0 / 27 * part + 16) / 116;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

TEST(Fields, SignalsAreAmongThem) {
  Frame frame;
  frame.element_scalars = {{"signal_u", {0, 2}}, {"region_a", {0, 1}}, {"twi", {1, 1}}};
  std::vector<std::string> titles;
  for (const ColourField& field : fields_of(frame))
    if (std::ranges::count(colour_fields(), field.name, &ColourField::name) == 0)
      titles.push_back(field.name + ": " + field.title());
  EXPECT_EQ(titles, (std::vector<std::string>{"signal_u: signal u", "twi: twi"}));
}

const ColourMap& map_named(const std::string& name) {
  return *std::ranges::find(colour_maps(), name, &ColourMap::name);
}

// Largest and smallest step of lightness between neighbouring colours.
std::pair<double, double> lightness_steps(const std::vector<Rgb>& colours, std::size_t first, std::size_t last) {
  double smallest = 1e9, largest = 0;
  for (std::size_t i = first; i < last; ++i) {
    const double step = lab_of(colours[i + 1])[0] - lab_of(colours[i])[0];
    smallest = std::min(smallest, std::abs(step));
    largest = std::max(largest, std::abs(step));
  }
  return {smallest, largest};
}

TEST(ColourMaps, LightnessFallsEvenlyWithTheValue) {
  const auto& colours = map_named("still").colours;
  for (std::size_t i = 0; i + 1 < colours.size(); ++i) EXPECT_LT(lab_of(colours[i + 1])[0], lab_of(colours[i])[0]) << i;
  const auto [smallest, largest] = lightness_steps(colours, 0, colours.size() - 1);
  EXPECT_LT(largest / smallest, 1.3);
}

TEST(ColourMaps, TwoSidedMapIsLightestInTheMiddleAndEvenOnBothSides) {
  const auto& colours = map_named("about").colours;
  const std::size_t middle = colours.size() / 2;
  for (std::size_t i = 1; i <= middle; ++i) {
    EXPECT_LT(lab_of(colours[middle - i])[0], lab_of(colours[middle - i + 1])[0]) << i;
    EXPECT_NEAR(lab_of(colours[middle - i])[0], lab_of(colours[middle + i])[0], 1.5) << i;
  }
  const auto [smallest, largest] = lightness_steps(colours, 0, colours.size() - 1);
  EXPECT_LT(largest / smallest, 1.3);
}

// Viénot, Brettel and Mollon 1999: what a dichromat sees, in linear light (protanopia, deuteranopia).
TEST(ColourMaps, SidesDifferForColourBlindEyes) {
  const auto& colours = map_named("about").colours;
  Mat3 protan, deutan;
  protan << 0.11238, 0.88762, 0, 0.11238, 0.88762, 0, 0.00401, -0.00401, 1;
  deutan << 0.29275, 0.70725, 0, 0.29275, 0.70725, 0, -0.02234, 0.02234, 1;
  const auto seen = [](const Mat3& eye, const Rgb& rgb) {
    Vec3 light;
    for (int i = 0; i < 3; ++i) light[i] = rgb[i] <= 0.04045 ? rgb[i] / 12.92 : std::pow((rgb[i] + 0.055) / 1.055, 2.4);
    light = (eye * light).cwiseMax(0).cwiseMin(1);
    Rgb result{};
    for (int i = 0; i < 3; ++i)
      result[i] = light[i] <= 0.0031308 ? 12.92 * light[i] : 1.055 * std::pow(light[i], 1 / 2.4) - 0.055;
    return lab_of(result);
  };
  const std::size_t last = colours.size() - 1;
  for (const Mat3& eye : {protan, deutan})
    for (const std::size_t i : {std::size_t{4}, std::size_t{8}, std::size_t{12}})
      EXPECT_GT((seen(eye, colours[i]) - seen(eye, colours[last - i])).norm(), 20) << i;
}

TEST(ColourRange, HoldsAllValuesAndIsRound) {
  const auto& fields = colour_fields();
  const auto range = [&](const std::string& name, double low, double high) {
    return colour_range(*std::ranges::find(fields, name, &ColourField::name), low, high);
  };
  EXPECT_DOUBLE_EQ(range("displacement", 0, 33.2).high, 35);
  EXPECT_DOUBLE_EQ(range("displacement", 0, 35).high, 35);
  EXPECT_DOUBLE_EQ(range("displacement", 0, 0).high, 1);
  EXPECT_DOUBLE_EQ(range("area-ratio", 0.55, 1.1).low, 0.5);
  EXPECT_DOUBLE_EQ(range("area-ratio", 0.55, 1.1).high, 1.5);
  EXPECT_DOUBLE_EQ(range("area-ratio", 0.2, 4.6).low, 0);
  EXPECT_DOUBLE_EQ(range("area-ratio", 0.2, 4.6).high, 2);
  EXPECT_DOUBLE_EQ(range("pressure", -310, 120).low, -350);
}

TEST(ColourOf, EndsAreHeldAndTheMiddleIsTheMiddle) {
  const ColourMap& map = map_named("still");
  EXPECT_EQ(colour_of(map, {0, 10}, -5), map.colours.front());
  EXPECT_EQ(colour_of(map, {0, 10}, 50), map.colours.back());
  EXPECT_EQ(colour_of(map, {0, 10}, 5), map.colours[map.colours.size() / 2]);
}

TEST(ColourFields, ComeFromArraysThatFramesHave) {
  for (const ColourField& field : colour_fields()) {
    if (field.name == "region") continue;  // of the arrays of all regions
    const bool of_nodes = std::ranges::find(node_columns(), field.array, &NodeColumn::name) != node_columns().end();
    const auto of_cells = std::ranges::find(cell_columns(), field.array, &CellColumn::name);
    const bool in_frames = of_cells != cell_columns().end() && of_cells->in_frames != InFrames::nothing;
    EXPECT_TRUE(field.on_nodes ? of_nodes : in_frames) << field.name;
  }
}

// However a sheet lies, the view `apical` looks at its apices, with x to the right where that can be; and it comes
// first.
TEST(Views, OfAnOpenSheetBeginAtItsApicalSide) {
  Frame sheet = frame_of(distorted_block({60, 40, 10, {6, 4, 1}, {1, 1, 2}}, 1, 3));
  const Vectors flat = sheet.positions;
  int cases = 0;
  for (const Mat3& turn : {Mat3(Mat3::Identity()), Mat3(Eigen::AngleAxisd(2.5, Vec3::UnitX())),
                           Mat3(Eigen::AngleAxisd(1.5, Vec3::UnitY()))}) {
    for (std::size_t n = 0; n < flat.size(); ++n) sheet.positions[n] = turn * flat[n];
    const View view = views_of(sheet).front();
    EXPECT_EQ(view.name, "apical");
    EXPECT_NEAR(view.sight.normalized().dot(turn * -Vec3::UnitZ()), 1, 0.01);
    EXPECT_GT(view.sight.cross(view.up).norm(), 0.1);
    EXPECT_GT(view.sight.cross(view.up).dot(cases == 2 ? Vec3::UnitY() : Vec3::UnitX()), 0.9);
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

TEST(Views, OfAClosedEmbryoBeginAtTheBelly) {
  const std::vector<View> of_embryo = views_of(frame_of(build_shell({460, 280, 40, {6, 3, 4}, {1, 1, 1}})));
  ASSERT_EQ(of_embryo.size(), views().size());
  for (std::size_t i = 0; i < views().size(); ++i) EXPECT_EQ(of_embryo[i].name, views()[i].name);
  EXPECT_EQ(of_embryo.front().name, "antero-ventral");
}

TEST(Views, AreNamedByTheAxes) {
  std::vector<View> views = plica::views();
  name_views(views, anatomical_axes());
  EXPECT_EQ(views[1].heading(), "ventral");
  name_views(views, plain_axes());
  const auto heading = [&](const char* name) { return std::ranges::find(views, name, &View::name)->heading(); };
  EXPECT_EQ(heading("antero-ventral"), "oblique");
  EXPECT_EQ(heading("ventral"), "from \u2212z");
  EXPECT_EQ(heading("side"), "from \u2212y");
  EXPECT_EQ(heading("cross-section"), "cut at x");
  EXPECT_EQ(heading("apical"), "apical");
  EXPECT_EQ(views[1].label, "from \u2212z, \u2212x to the left");
  for (const View& view : views)
    for (const char* word : {"ventral", "anterior", "front", "left side", "below"})
      EXPECT_SAYS_NOT((view.heading() + view.label), word) << view.label;
  EXPECT_EQ(cross_section_at(5, plain_axes()).label, "cut across at x = 5 µm, from \u2212x");
  EXPECT_EQ(picture_letters(plain_axes()), EmbryoAxes{});
  EXPECT_EQ(picture_letters(anatomical_axes())[2][1], "D");
}

// Where regions overlap, a cell has the number of the smallest.
TEST(FieldValues, RegionsAreNumberedByName) {
  Frame frame;
  frame.elements.resize(4);
  frame.element_scalars = {{"region_belly", {1, 1, 1, 0}},
                           {"region_everything", {1, 1, 1, 1}},
                           {"region_row", {0, 1, 0, 0}},
                           {"cell_id", {0, 1, 2, 3}}};
  const auto field = std::ranges::find(colour_fields(), "region", &ColourField::name);
  EXPECT_EQ(regions_of(frame), (std::vector<std::string>{"belly", "everything", "row"}));
  EXPECT_EQ(coloured_regions(frame), (std::vector<std::string>{"belly", "row"}));
  EXPECT_EQ(field_values(frame, *field), (std::vector<double>{1, 2, 1, 0}));
}

// A legend has what is there and no more: regions by name, generations up to the last.
TEST(StepNames, AreThoseThatAPictureHas) {
  const auto named = [](const char* name) { return *std::ranges::find(colour_fields(), name, &ColourField::name); };
  Frame frame;
  frame.elements.resize(2);
  frame.element_scalars = {{"region_all", {1, 1}}, {"region_belly", {1, 0}}};
  using Names = std::vector<std::string>;
  EXPECT_EQ(step_names(frame, named("region"), 1), (Names{"other cells", "belly"}));
  EXPECT_EQ(step_names(frame, named("self-intersections"), 0), (Names{"no", "yes"}));
  EXPECT_EQ(step_names(frame, named("generation"), 2), (Names{"0", "1", "2"}));
  for (const char* name : {"a", "b", "c", "d", "e", "f"}) frame.element_scalars["region_" + std::string(name)] = {0, 1};
  const Names many = step_names(frame, named("region"), 7);
  EXPECT_EQ(many.size(), named("region").map().colours.size()) << "no more than there are colours";
  EXPECT_EQ(many.back(), "d …") << "and all others";
}

TEST(CrossSectionAt, CutsNextToThePlaceAndIsCalledByIt) {
  const View view = cross_section_at(-125);
  EXPECT_EQ(view.cut_axis, 0);
  EXPECT_DOUBLE_EQ(view.cut_um, view_cut_um - 125);
  EXPECT_EQ(view.name, "x = \u2212125 µm");
}

TEST(FieldValues, RefusesAFrameWithoutTheArray) {
  EXPECT_THROW(field_values(Frame{}, colour_fields().front()), FileError);
}

// `count` cubes of 10 um in a row along x, each of two elements one above the other where `layers` is 2.
Frame row_of_cubes(int count, int layers) {
  Frame frame;
  const auto node = [&](int i, int j, int k) { return NodeId(i + (count + 1) * (j + 2 * k)); };
  for (int k = 0; k <= layers; ++k)
    for (int j = 0; j < 2; ++j)
      for (int i = 0; i <= count; ++i) frame.positions.emplace_back(10.0 * i, 10.0 * j, 10.0 * k / layers);
  for (int k = 0; k < layers; ++k)
    for (int i = 0; i < count; ++i) {
      frame.elements.push_back({node(i, 0, k), node(i + 1, 0, k), node(i + 1, 1, k), node(i, 1, k), node(i, 0, k + 1),
                                node(i + 1, 0, k + 1), node(i + 1, 1, k + 1), node(i, 1, k + 1)});
      frame.element_scalars["cell_id"].push_back(i);
    }
  return frame;
}

TEST(BoundarySurface, OutlinesPartCellsAndNotTheElementsOfOne) {
  const BoundarySurface coarse = boundary_surface_of(row_of_cubes(3, 1)),
                        fine = boundary_surface_of(row_of_cubes(3, 2));
  EXPECT_EQ(coarse.facets.size(), 14u);
  EXPECT_EQ(coarse.outlines.size(), 28u);  // every edge of three cubes
  EXPECT_EQ(fine.facets.size(), 6u + 2 * 8u);
  // Upright edges are of two pieces now; edges between the layers lie within a cell's side and are not drawn.
  EXPECT_EQ(fine.outlines.size(), 28u + 8u);
  EXPECT_EQ(std::ranges::count(coarse.facets, 5, &BoundaryFacet::face), 3);
  EXPECT_EQ(std::ranges::count(coarse.facets, 4, &BoundaryFacet::face), 3);
}

TEST(BoundarySurface, FacetsLookOutward) {
  const Frame frame = row_of_cubes(2, 1);
  Vec3 sum = Vec3::Zero();
  double volume = 0;
  for (const BoundaryFacet& facet : boundary_surface_of(frame).facets) {
    const auto at = [&](int i) { return frame.positions[facet.nodes[i].index()]; };
    const Vec3 area = (at(2) - at(0)).cross(at(3) - at(1)) / 2;
    sum += area;
    volume += area.dot(at(0) + at(2)) / 6;
  }
  EXPECT_NEAR(sum.norm(), 0, 1e-12);
  EXPECT_NEAR(volume, 2000, 1e-9);
}

TEST(BoundarySurface, RefusesAFrameWithoutCells) {
  Frame frame = row_of_cubes(1, 1);
  frame.element_scalars.clear();
  EXPECT_THROW(boundary_surface_of(frame), FileError);
}

TEST(CutByPlane, CutsASquareOutOfACube) {
  const Frame frame = row_of_cubes(3, 1);
  const auto polygons = cut_by_plane(frame, 0, 12.5);
  ASSERT_EQ(polygons.size(), 1u);
  EXPECT_EQ(polygons[0].element, 1u);
  ASSERT_EQ(polygons[0].corners.size(), 4u);
  double area = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 a = polygons[0].corners[i].of(frame.positions), b = polygons[0].corners[(i + 1) % 4].of(frame.positions);
    EXPECT_DOUBLE_EQ(a.x(), 12.5);
    area += a.cross(b).x() / 2;
  }
  EXPECT_NEAR(area, 100, 1e-9);
  EXPECT_EQ(cut_by_plane(frame, 1, 5).size(), 3u);
  EXPECT_TRUE(cut_by_plane(frame, 2, 50).empty());
}

TEST(PackedArrays, KeepsDifferencesBytePlaneByBytePlane) {
  PackedArrays arrays;
  const std::vector<std::uint16_t> small = {0x0102, 0x0304, 0x0103, 0x0300};
  const std::vector<std::uint32_t> large = {0x01020304, 0x01020303};
  arrays.add("small", small, 2);
  arrays.add("large", large, 1);
  // Differences: 0102 0304 0001 fffc, then 01020304 ffffffff; lowest bytes first.
  EXPECT_EQ(arrays.bytes(), std::string("\x02\x04\x01\xfc\x01\x03\x00\xff\x04\xff\x03\xff\x02\xff\x01\xff", 16));
  const auto index = arrays.index();
  EXPECT_EQ(index[1]["name"], "large");
  EXPECT_EQ(index[1]["bits"], 32);
  EXPECT_EQ(index[1]["offset"], 8);
  EXPECT_EQ(index[1]["count"], 2);
}

TEST(Quantiser, IsExactAtItsEndsAndWithinHalfAStepBetween) {
  Quantiser range;
  EXPECT_EQ(range.step_of(3), 0);  // nothing known yet
  for (const double value : {-2.0, 5.0, 1.0}) range.include(value);
  EXPECT_EQ(range.step_of(-2), 0);
  EXPECT_EQ(range.step_of(5), 65535);
  EXPECT_EQ(range.step_of(7), 65535);
  for (const double value : {-1.9, 0.0, 3.3333}) {
    const double back = -2 + 7.0 * range.step_of(value) / 65535;
    EXPECT_NEAR(back, value, 0.5 * 7 / 65535 * (1 + 1e-9));
  }
}

}  // namespace
