// Pictures as files, drawn, read back and looked at pixel by pixel; and what a report has of a run.
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPNGReader.h>

#include <cstdlib>

#include "core/errors.hpp"
#include "record/mesh_writer.hpp"
#include "show/boundary_surface.hpp"
#include "show/picture_layout.hpp"
#include "show/report.hpp"
#include "support/frames.hpp"
#include "support/looks.hpp"
#include "support/own_folder.hpp"
#include "support/tissues.hpp"

namespace {

struct Image {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;  // lower row first

  [[nodiscard]] std::array<int, 3> at(double x, double y) const {
    const std::size_t place =
        3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
    return {rgb[place], rgb[place + 1], rgb[place + 2]};
  }
};

Image read_png(const std::string& bytes) {
  vtkNew<vtkPNGReader> reader;
  reader->SetMemoryBuffer(bytes.data());
  reader->SetMemoryBufferLength(static_cast<vtkIdType>(bytes.size()));
  reader->Update();
  vtkImageData& data = *reader->GetOutput();
  Image image{data.GetDimensions()[0], data.GetDimensions()[1], {}};
  EXPECT_EQ(data.GetNumberOfScalarComponents(), 3);
  const auto* first = static_cast<const unsigned char*>(data.GetScalarPointer());
  image.rgb.assign(first, first + std::size_t{3} * image.width * image.height);
  return image;
}

int distance(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  return std::max({std::abs(a[0] - b[0]), std::abs(a[1] - b[1]), std::abs(a[2] - b[2])});
}

int distance(const std::array<int, 3>& a, const Rgb& colour) {
  return distance(
      a, std::array{static_cast<int>(std::lround(255 * colour[0])), static_cast<int>(std::lround(255 * colour[1])),
                    static_cast<int>(std::lround(255 * colour[2]))});
}

/// The pill, its belly drawn in; cells have pressures of their own.
Picture pill_picture(const std::vector<std::string>& rows, const std::string& colour) {
  const Tissue tissue = build_shell({460, 280, 40, {6, 3, 4}, {1, 1, 1}});
  Vectors displacements;
  for (const Vec3& place : tissue.rest_positions)
    displacements.emplace_back(0, 0, place.z() < 0 ? 30 * std::pow(place.z() / 140, 2) : 0);
  Frame frame = frame_of(tissue, displacements);
  for (std::size_t n = 0; n < frame.positions.size(); ++n) frame.positions[n] += displacements[n];
  for (std::size_t e = 0; e < frame.elements.size(); ++e)
    frame.element_scalars["pressure_Pa"].push_back(200 * std::sin(static_cast<double>(37 * e)));
  Picture picture;
  picture.columns.push_back({"5 min", frame});
  for (const std::string& name : rows)
    picture.rows.push_back({view(name), half_size_um(tissue.rest_positions, view(name))});
  picture.field = field(colour);
  picture.range = colour == "pressure" ? ColourRange{-200, 200} : ColourRange{0, 30};
  picture.width_px = 500;
  return picture;
}

/// Where a place of the embryo is, in pixels.
std::array<double, 2> pixel_of(const Layout& layout, const Panel& panel, const View& seen, const Vec3& place) {
  const auto [right, up] = screenwise(seen);
  return {panel.box.left + panel.box.width / 2 + place.dot(right) / layout.um_per_px,
          panel.box.bottom + panel.box.height / 2 + place.dot(up) / layout.um_per_px};
}

TEST(Picture, HasTheSizeAskedForAndIsTheSameTwice) {
  Picture picture = pill_picture({"antero-ventral", "cross-section"}, "displacement");
  picture.width_px = 640, picture.height_px = 481;
  Painter painter;
  const std::string bytes = painter.png(picture);
  const Image image = read_png(bytes);
  EXPECT_EQ(image.width, 640);
  EXPECT_EQ(image.height, 481);
  EXPECT_EQ(image.at(1, 1), (std::array{255, 255, 255}));
  EXPECT_EQ(painter.png(picture), bytes);
}

TEST(Picture, ColoursOfASectionAreThoseOfTheLegend) {
  int cases = 0;
  for (const char* colour : {"pressure", "displacement"}) {
    const Picture picture = pill_picture({"cross-section"}, colour);
    const Layout layout = make_layout(picture);
    const Image image = read_png(Painter().png(picture));
    const Frame& frame = picture.columns[0].frame;
    const std::vector<double> values = field_values(frame, picture.field);
    for (const CutPolygon& polygon : cut_by_plane(frame, 0, view_cut_um)) {
      Vec3 middle = Vec3::Zero();
      double value = 0;
      for (const auto& corner : polygon.corners) {
        const auto count = static_cast<double>(polygon.corners.size());
        middle += corner.of(frame.positions) / count;
        value += (picture.field.on_nodes ? corner.of(values) : values[polygon.element]) / count;
      }
      const auto [x, y] = pixel_of(layout, layout.panels[0], picture.rows[0].view, middle);
      EXPECT_LE(distance(image.at(x, y), colour_of(picture.field.map(), picture.range, value)), 4)
          << colour << " " << value << " at " << x << " " << y;
      ++cases;
    }
  }
  std::cout << cases << " cells\n";
  EXPECT_GT(cases, 20);
}

TEST(Picture, OfASymmetricEmbryoIsSymmetric) {
  Picture picture = pill_picture({"ventral"}, "displacement");
  picture.letters = {};
  const Box box = make_layout(picture).panels[0].box;
  const Image image = read_png(Painter().png(picture));
  const double middle_x = box.left + box.width / 2, middle_y = box.bottom + box.height / 2;
  int differ_upwards = 0, differ_across = 0, coloured = 0;
  for (double y = 0.5; y < std::floor(box.height / 2); ++y)
    for (double x = 0.5; x < std::floor(box.width / 2); ++x) {
      const auto here = image.at(middle_x - x, middle_y - y);
      coloured += here != std::array{255, 255, 255};
      differ_upwards += distance(here, image.at(middle_x - x, middle_y + y)) > 40;
      differ_across += distance(here, image.at(middle_x + x, middle_y - y)) > 40;
    }
  EXPECT_GT(coloured, 5000);
  // The smoothing of lines is not symmetric to the last pixel.
  EXPECT_LT(differ_upwards, coloured / 100);
  EXPECT_LT(differ_across, coloured / 100);
}

// A sheet of 20 um whose lower side has walls that its upper side has not: nothing of them is seen from above.
TEST(Picture, OfASmallSheetShowsNoEdgeBehindItsSurface) {
  Tissue sheet = mapped_lattice(4, 4, 1, [](int i, int j, int k) { return Vec3(5 * i - 10, 5 * j - 10, 0.5 * k); });
  Picture picture;
  picture.columns.push_back({"", frame_of(sheet)});
  const View seen = {"tilted", "", {0.4, 0.3, -0.87}, {0, 1, 0}, {}};
  picture.rows.push_back({seen, half_size_um(sheet.rest_positions, seen)});
  picture.field = field("displacement");
  picture.width_px = 800;
  const Layout layout = make_layout(picture);
  const Image image = read_png(Painter().png(picture));
  int cases = 0;
  // The edges of the lower side, 0.5 um below the upper one, are seen through its cells' middles where they are drawn
  // in front of it.
  for (const auto& place : sheet.rest_positions) {
    if (place.z() > 0 || place.x() > 9 || place.y() < -9) continue;  // that of the near side is seen
    const Vec3 on_edge = place + Vec3(2.5, 0, 0);
    const auto [x, y] = pixel_of(layout, layout.panels[0], seen, on_edge);
    ++cases;
    EXPECT_GT(image.at(x, y)[0], 150) << x << " " << y;
  }
  EXPECT_EQ(cases, 16);
}

TEST(Picture, HasALegendInTheColoursOfItsMap) {
  const Picture picture = pill_picture({"ventral"}, "displacement");
  const Layout layout = make_layout(picture);
  const Image image = read_png(Painter().png(picture));
  const ColourMap& map = picture.field.map();
  int found = 0;
  for (const Rectangle& rectangle : layout.rectangles) {
    const Box& box = rectangle.box;
    if (box.height > 1.01 || rectangle.colour[0] == rectangle.colour[2]) continue;  // lines
    found += distance(image.at(box.left + box.width / 2, box.bottom + box.height / 2), rectangle.colour) < 12;
  }
  EXPECT_GT(found, 60);
  // A label is darker than paper somewhere.
  for (const Label& label : layout.labels) {
    int darkest = 255;
    for (double dy = -4; dy <= 4; ++dy)
      for (double dx = -8; dx <= 8; ++dx) {
        const double x = label.x + dx + (label.is_centred ? 0 : 8);
        darkest = std::min(darkest, image.at(std::min(x, image.width - 1.0), label.y + dy)[1]);
      }
    EXPECT_LT(darkest, 140) << label.text;
  }
  EXPECT_EQ(map.name, "still");
}

TEST(Picture, OfAnotherRangeHasOtherColours) {
  Picture picture = pill_picture({"cross-section"}, "displacement");
  Painter painter;
  const Layout layout = make_layout(picture);
  const auto [x, y] = pixel_of(layout, layout.panels[0], picture.rows[0].view, {0, 0, -140 + 30 + 15});
  const auto dark = read_png(painter.png(picture)).at(x, y);
  picture.range.high = 300;
  const auto light = read_png(painter.png(picture)).at(x, y);
  EXPECT_GT(light[0], dark[0] + 60);
}

TEST(Picture, ShowsTheShellWhereTheEmbryoHasLeftIt) {
  Picture picture = pill_picture({"cross-section"}, "displacement");
  Painter painter;
  picture.shell = Capsule{90, 140};
  const Layout layout = make_layout(picture);
  const double half_band_um = 0.15 * layout.font_px * layout.um_per_px / 2;
  const auto [x, y] = pixel_of(layout, layout.panels[0], picture.rows[0].view, {0, 0, -140 - half_band_um});
  EXPECT_LT(read_png(painter.png(picture)).at(x, y)[0], 220);
  picture.shell.reset();
  EXPECT_EQ(read_png(painter.png(picture)).at(x, y)[0], 255);
}

namespace fs = std::filesystem;
// The numbers of a packed array, read back as the page does it.
std::vector<std::uint32_t> unpacked(const ReportRun& run, const std::string& name) {
  for (const auto& entry : run.json["arrays"]) {
    if (entry["name"] != name) continue;
    const std::size_t count = entry["count"], period = entry["period"], offset = entry["offset"];
    const std::size_t size = entry["bits"].get<std::size_t>() / 8;
    std::vector<std::uint32_t> numbers(count);
    for (std::size_t i = 0; i < count; ++i) {
      for (std::size_t b = 0; b < size; ++b)
        numbers[i] |= std::uint32_t{static_cast<unsigned char>(run.frames.bytes()[offset + b * count + i])} << (8 * b);
      if (i >= period) numbers[i] += numbers[i - period];
      if (size == 2) numbers[i] &= 0xffff;
    }
    return numbers;
  }
  ADD_FAILURE() << "no array " << name;
  return {};
}

class ReportRunTest : public OwnFolder {
 protected:
  ReportRunTest() { fs::create_directories(folder / "frames"); }
  // Frame i is the block moved by i um along x; from frame `divided_at` on it is another one, of more cells. As in a
  // run, the row of series.csv at the time of the division still counts those before it. From `given_at` on there is an
  // array that is not plica's.
  void write_frames(int count, int divided_at = 1000, int given_at = 1000) const {
    std::vector<std::pair<double, std::string>> entries;
    for (int i = 0; i < count; ++i) {
      const Tissue& tissue = i < divided_at ? block : finer;
      Vectors positions = tissue.rest_positions, displacements(positions.size(), Vec3(i, 0, 0));
      for (Vec3& position : positions) position.x() += i;
      std::vector<int> ids(tissue.cells.size()), zeros(tissue.cells.size(), 0);
      std::vector<double> values(tissue.cells.size(), 0.25 * i);
      for (std::size_t c = 0; c < ids.size(); ++c) ids[c] = static_cast<int>(c);
      MeshArrays arrays;
      arrays.node_vectors = {{"displacement_um", displacements}, {"velocity_um_per_s", displacements}};
      arrays.cell_integers = {{"cell_id", ids}, {"generation", zeros}, {"region_some", zeros}};
      for (const char* name : {"volume_um3", "volume_error", "apical_area_ratio", "pressure_Pa", "activity"})
        arrays.cell_scalars.emplace_back(name, values);
      if (i >= given_at) arrays.cell_scalars.emplace_back("given", values);
      const std::string file = "frames/frame_" + std::to_string(i) + ".vtu";
      write_mesh(folder / file, tissue, positions, arrays, 10.0 * i);
      entries.emplace_back(10.0 * i, file);
    }
    write_collection(folder / "frames.pvd", entries);
  }

  const Tissue block = distorted_block({60, 40, 40, {3, 2, 1}, {1, 1, 1}}, 2, 9);
  const Tissue finer = distorted_block({60, 40, 40, {3, 3, 1}, {1, 1, 1}}, 2, 9);
};

TEST_F(ReportRunTest, HoldsPositionsAndValuesOfEveryFrame) {
  write_frames(3);
  const ReportRun run = read_report_run(folder, most_frame_bytes);
  ASSERT_EQ(run.json["topologies"].size(), 1u);
  EXPECT_EQ(run.json["topologies"][0]["times_s"], nlohmann::ordered_json({0, 10, 20}));
  const auto steps = unpacked(run, "0/positions");
  const std::size_t nodes = block.rest_positions.size();
  ASSERT_EQ(steps.size(), 3 * 3 * nodes);
  for (std::size_t f = 0; f < 3; ++f)
    for (std::size_t n = 0; n < nodes; ++n)
      for (std::size_t i = 0; i < 3; ++i) {
        const double low = run.json["box"]["low"][i], high = run.json["box"]["high"][i];
        const double position = low + (high - low) * steps[3 * (f * nodes + n) + i] / 65535;
        const double expected = block.rest_positions[n][static_cast<int>(i)] + (i == 0 ? static_cast<double>(f) : 0.0);
        EXPECT_NEAR(position, expected, 0.51 * (high - low) / 65535);
      }
  const auto pressures = unpacked(run, "0/field/pressure");
  EXPECT_EQ(pressures.front(), 0u);
  EXPECT_EQ(pressures.back(), 65535u);
  EXPECT_DOUBLE_EQ(run.fields.at("pressure").high, 0.5);
  EXPECT_EQ(run.json["regions"], nlohmann::ordered_json({"some"}));
  EXPECT_EQ(run.json["coloured_regions"], nlohmann::ordered_json({"some"}));
}

TEST_F(ReportRunTest, NewCellsAreANewTopology) {
  write_frames(5, 3);
  const ReportRun run = read_report_run(folder, most_frame_bytes);
  ASSERT_EQ(run.json["topologies"].size(), 2u);
  EXPECT_EQ(run.json["topologies"][0]["cells"], 6);
  EXPECT_EQ(run.json["topologies"][1]["cells"], 9);
  EXPECT_EQ(run.json["topologies"][1]["times_s"], nlohmann::ordered_json({30, 40}));
}

TEST_F(ReportRunTest, AnArrayMayComeLater) {
  write_frames(5, 3, 2);
  const ReportRun run = read_report_run(folder, most_frame_bytes);
  ASSERT_EQ(run.colours.back().name, "given");
  EXPECT_DOUBLE_EQ(run.fields.at("given").high, 1);
  const auto values = unpacked(run, "0/field/given");
  ASSERT_EQ(values.size(), 3 * block.cells.size());
  EXPECT_EQ(values[2 * block.cells.size() - 1], 0u);
  EXPECT_EQ(values.back(), 32768u);
  EXPECT_EQ(unpacked(run, "1/field/given").back(), 65535u);
}

TEST_F(ReportRunTest, ThinsFramesByItsRuleAndSaysSo) {
  write_frames(20, 11);
  const double bytes_a_frame = 2.0 * static_cast<double>(finer.rest_positions.size() * 5 + finer.elements.size() * 9);
  const ReportRun run = read_report_run(folder, 7 * bytes_a_frame);
  EXPECT_EQ(run.json["every"], 4);
  EXPECT_EQ(run.json["frames_saved"], 20);
  // Every 4th, the last, and the two on both sides of the division at 110 s.
  EXPECT_EQ(run.json["topologies"][0]["times_s"], nlohmann::ordered_json({0, 40, 80, 100}));
  EXPECT_EQ(run.json["topologies"][1]["times_s"], nlohmann::ordered_json({110, 120, 160, 190}));
  EXPECT_EQ(read_report_run(folder, 100 * bytes_a_frame).json["every"], 1);
  // However little there is room for, the ends and the division stay.
  EXPECT_EQ(read_report_run(folder, 1).json["topologies"][0]["times_s"], nlohmann::ordered_json({0, 100}));
  EXPECT_EQ(read_report_run(folder, 1).json["topologies"][1]["times_s"], nlohmann::ordered_json({110, 190}));
}

// What a page of several runs says of them.
nlohmann::json data_of(const std::string& page) {
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const std::size_t from = page.find(begin) + begin.size();
  return nlohmann::json::parse(page.substr(from, page.find("</script>", from) - from));
}

TEST_F(ReportRunTest, SeveralRunsAreToldApartByKeysAndNames) {
  write_frames(1);
  std::vector<fs::path> runs;
  for (const auto& [name, scenario] : std::vector<std::pair<std::string, std::string>>{
           {"soft/run", "title = \"Fold\"\n[elasticity]\nyoung_modulus_Pa = 500\npoisson_ratio = 0.45\n"},
           {"stiff/run", "title = \"Fold\"\n[elasticity]\nyoung_modulus_Pa = 1000\npoisson_ratio = 0.45\n"},
           {"none", ""}}) {
    runs.push_back(folder / name);
    fs::create_directories(runs.back());
    fs::copy(folder / "frames", runs.back() / "frames");
    fs::copy(folder / "frames.pvd", runs.back() / "frames.pvd");
    std::ofstream(runs.back() / "summary.json") << R"({"title": "Fold"})";
    if (!scenario.empty()) std::ofstream(runs.back() / "scenario.toml") << scenario;
  }
  const std::string page = report_page_of(runs);
  EXPECT_SAYS(page, "<title>Fold</title>");
  const nlohmann::json data = data_of(page);
  EXPECT_EQ(data["varied"],
            nlohmann::json::parse(R"([{"key": "elasticity.young_modulus_Pa", "values": ["500", "1000", ""]}])"));
  EXPECT_EQ(data["runs"][0]["name"], "soft/run");
  EXPECT_EQ(data["runs"][1]["name"], "stiff/run");
  EXPECT_EQ(data["runs"][2]["name"], "none");
}

TEST_F(ReportRunTest, NamesFitTheTissue) {
  write_frames(1);
  const auto told = [&](const std::string& scenario) {
    std::ofstream(folder / "scenario.toml") << scenario;
    const nlohmann::json data = data_of(report_page_of({folder}));
    const nlohmann::json& run = data["runs"][0];
    return nlohmann::json{run["axes"][0], run["letters"][0], run["depth_word"], data["views"][2]["title"]};
  };
  const std::string sheet = "[embryo]\nshape = \"sheet\"\n";
  EXPECT_EQ(told(sheet), nlohmann::json::parse(R"([["\u2212x", "+x"], ["\u2212x", "+x"], "fold", "from \u2212z"])"));
  EXPECT_EQ(told(sheet + "axes = [\"proximal-distal\", \"left-right\", \"ventral-dorsal\"]\n"),
            nlohmann::json::parse(R"([["proximal", "distal"], ["P", "Di"], "furrow", "from ventral"])"));
  EXPECT_EQ(told(""), nlohmann::json::parse(R"([["anterior", "posterior"], ["A", "P"], "furrow", "ventral"])"));
}

}  // namespace
