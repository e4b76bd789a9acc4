#include "show/looks.hpp"

#include <cmath>
#include <map>

#include "measure/cell_columns.hpp"
#include "show/boundary_surface.hpp"
#include "tissue/faces.hpp"
#include "tissue/mesh_faces.hpp"

namespace plica {
namespace {

// Read colours written as rrggbb.
std::vector<Rgb> colours_in(const std::string& text) {
  std::vector<Rgb> colours;
  for (std::size_t at = 0; at < text.size(); at += 7) {
    const unsigned long bits = std::stoul(text.substr(at, 6), nullptr, 16);
    colours.push_back({(bits >> 16) / 255.0, (bits >> 8 & 0xff) / 255.0, (bits & 0xff) / 255.0});
  }
  return colours;
}

// Smallest round number (1, 1.2, 1.5, ... times a power of ten) not below `value`.
double rounded_up(double value) {
  if (!(value > 0)) return 1;
  constexpr double slack = 1e-9;  // values that are round up to rounding errors are kept
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double factor : {1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0, 8.0, 10.0})
    if (factor * power * (1 + slack) >= value) return factor * power;
  return 10 * power;
}

double size_of(const std::vector<double>& members) {
  return static_cast<double>(std::ranges::count_if(members, [](double flag) { return flag > 0; }));
}

// Smallest region of each element as an index into coloured_regions(), from 1; 0: none.
std::vector<double> region_numbers(const Frame& frame) {
  std::vector<double> numbers(frame.elements.size(), 0.0), sizes(frame.elements.size(), 1e300);
  double number = 0;
  for (const std::string& name : coloured_regions(frame)) {
    ++number;
    const std::vector<double>& members = frame.element_scalars.at(std::string(region_prefix) + name);
    const double size = size_of(members);
    for (std::size_t e = 0; e < numbers.size(); ++e)
      if (members[e] > 0 && size < sizes[e]) numbers[e] = number, sizes[e] = size;
  }
  return numbers;
}

}  // namespace

const std::vector<ColourMap>& colour_maps() {
  // Cells at rest are light. Rejected: viridis, whose yellow end becomes muddy in shade. The first two are interpolated
  // in CIE L*a*b* between (96, -3, 10), (78, -18, 2), (59, -20, -18), (40, -4, -33), (21, 8, -30), and between
  // (25, 8, -38), (60, -10, -32), (95, 0, 3), (60, 22, 42), (25, 24, 32). The last are Okabe and Ito's colours for any
  // kind of colour vision, light ones first.
  static const std::vector<ColourMap> maps = {
      {"still", colours_in("f6f5e0 ebefdc e0ead7 d5e5d3 cae0ce bedaca b3d5c5 a8d0c1 9ccabd 92c4bb 88beb9 7eb8b7 74b2b5 "
                           "69abb3 5da5b1 509faf 4299ad 3e92aa 3a8ba7 3584a3 307ea0 2b779d 26709a 1f6a97 186394 195d8d "
                           "1a5686 1b5080 1b4a79 1b4372 1b3d6c 1a3765 19315f")},
      {"about", colours_in("013b75 0e467f 195189 225c94 2a689e 3174a8 3980b3 408cbe 4798c8 63a3cd 7baed1 91b8d6 a6c3da "
                           "bacede cddae2 e0e5e7 f3f0eb f0e2d5 ecd3c0 e8c5ab e2b796 dca982 d69b6e cf8e5a c78047 ba753e "
                           "ae6a36 a15f2f 955427 88491f 7c3f18 703510 642a09")},
      {"steps", colours_in("e6e6e0 e69e00 57b5e8 009e73 cc78a6 d65e00")}};
  return maps;
}

const ColourMap& ColourField::map() const { return colour_maps()[static_cast<std::size_t>(kind)]; }

std::string ColourField::title() const { return unit.empty() ? label : fmt::format("{}, {}", label, unit); }

const std::vector<ColourField>& colour_fields() {
  static const std::vector<ColourField> fields = {
      {"displacement", "displacement", "µm", "displacement_um", true},
      {"speed", "speed", "µm/s", "velocity_um_per_s", true},
      {"area-ratio", "apical area / reference area", "", "apical_area_ratio", false, ScaleKind::about, 1},
      {"pressure", "pressure", "Pa", "pressure_Pa", false, ScaleKind::about, 0},
      {"volume-error", "volume error", "", "volume_error", false, ScaleKind::about, 0},
      {"volume", "volume", "µm³", "volume_um3"},
      {"contraction", "contraction activity", "", "activity"},
      {"strength", "contraction strength", "", "strength"},
      {"generation", "generation", "", "generation", false, ScaleKind::steps},
      {"region", "region", "", "region", false, ScaleKind::steps},
      {"self-intersections", "self-intersecting", "", "self_intersecting", false, ScaleKind::steps}};
  return fields;
}

std::vector<ColourField> fields_of(const Frame& frame) {
  std::vector<ColourField> fields = colour_fields();
  const std::vector<std::string> plicas = names_of(fields);
  for (const auto& [name, values] : frame.element_scalars)
    if (name.starts_with(array_of_signal("")))
      fields.push_back({name, "signal " + name.substr(array_of_signal("").size()), "", name});
    else if (!is_plicas(name) && std::ranges::find(plicas, name) == plicas.end())
      fields.push_back({name, name, "", name});
  return fields;
}

std::vector<std::string> regions_of(const Frame& frame) {
  std::vector<std::string> names;
  for (const auto& [name, values] : frame.element_scalars)
    if (name.starts_with(region_prefix)) names.push_back(name.substr(region_prefix.size()));
  return names;
}

std::vector<std::string> coloured_regions(const Frame& frame) {
  std::vector<std::string> names = regions_of(frame);
  std::erase_if(names, [&](const std::string& name) {
    const std::vector<double>& members = frame.element_scalars.at(std::string(region_prefix) + name);
    return size_of(members) == static_cast<double>(members.size());
  });
  return names;
}

std::vector<double> field_values(const Frame& frame, const ColourField& field) {
  if (field.array == "region") return region_numbers(frame);
  // Snapshots of older versions lack this array; the values are unknown.
  if ((field.array == "self_intersecting" || field.array == "strength") && !frame.element_scalars.contains(field.array))
    return std::vector<double>(frame.elements.size(), 0.0);
  if (!field.on_nodes) return values_in(frame.element_scalars, field.array);
  const Vectors& vectors = values_in(frame.node_vectors, field.array);
  std::vector<double> lengths;
  lengths.reserve(vectors.size());
  for (const Vec3& vector : vectors) lengths.push_back(vector.norm());
  return lengths;
}

std::vector<std::string> step_names(const Frame& frame, const ColourField& field, double largest) {
  if (field.name == "self-intersections") return {"no", "yes"};
  std::vector<std::string> names;
  if (field.name == "region") {
    names = coloured_regions(frame);
    names.insert(names.begin(), "other cells");
  } else {
    for (int step = 0; step <= static_cast<int>(largest); ++step) names.push_back(fmt::format("{}", step));
  }
  // With more steps than colours, the last colour has the rest.
  const std::size_t most = field.map().colours.size();
  if (names.size() > most) {
    names.resize(most);
    names.back() += " …";
  }
  return names;
}

ColourRange colour_range(const ColourField& field, double smallest, double largest) {
  switch (field.kind) {
    case ScaleKind::from_zero:
      return {smallest < 0 ? -rounded_up(-smallest) : 0, rounded_up(largest)};
    case ScaleKind::about: {
      double reach = rounded_up(std::max(field.centre - smallest, largest - field.centre));
      // Ratios are not negative; values above twice the centre have the colour of the largest.
      if (field.centre > 0) reach = std::min(reach, field.centre);
      return {field.centre - reach, field.centre + reach};
    }
    case ScaleKind::steps:
      break;
  }
  return {0, static_cast<double>(field.map().colours.size() - 1)};
}

Rgb colour_of(const ColourMap& map, const ColourRange& range, double value) {
  const std::vector<Rgb>& colours = map.colours;
  const double part = std::clamp((value - range.low) / (range.high - range.low), 0.0, 1.0);
  const double place = part * static_cast<double>(colours.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), colours.size() - 2);
  Rgb colour = colours[low];
  for (int i = 0; i < 3; ++i) colour[i] += (place - static_cast<double>(low)) * (colours[low + 1][i] - colours[low][i]);
  return colour;
}

const std::vector<View>& views() {
  // +x posterior, +y right, +z dorsal.
  static const std::vector<View> all = {
      {"antero-ventral", "from below and in front", {0.55, 0.2, 0.8}, {0.15, -0.9, 0.3}, {}},
      {"ventral", "from below, anterior to the left", {0, 0, 1}, {0, -1, 0}, {}},
      {"side", "from the left side, anterior to the left", {0, 1, 0}, {0, 0, 1}, {}},
      {"cross-section", "cut across the middle, from the front", {1, 0, 0}, {0, 0, 1}, 0},
      {"sagittal-section", "cut along the midline, anterior to the left", {0, 1, 0}, {0, 0, 1}, 1},
      {"apical", "the apical side from outside", {0, 0, -1}, {0, 1, 0}, {}}};
  return all;
}

std::vector<View> views_of(const Frame& rest) {
  std::vector<View> views = plica::views();
  Facing facing;
  for (const auto& element : rest.elements) facing.add(gather(rest.positions, face_nodes(element, apical_face)));
  if (!facing.is_one_way()) return views;
  // x to the right, projected across the viewing direction; if parallel to it, y.
  const auto apical = std::ranges::find(views, "apical", &View::name);
  apical->sight = -facing.area_vectors.normalized();
  const bool along_x = std::abs(apical->sight.x()) > 0.9;
  apical->up = (along_x ? Vec3::UnitY() : Vec3::UnitX()).cross(apical->sight);
  std::rotate(views.begin(), apical, apical + 1);
  return views;
}

void name_views(std::vector<View>& views, const EmbryoAxes& axes) {
  if (axes == anatomical_axes()) return;
  const std::string &front = axes[0][0], &left = axes[1][0], &below = axes[2][0];
  const std::string along = fmt::format(", {} to the left", front);
  const std::map<std::string, std::array<std::string, 2>> words = {
      {"antero-ventral", {"oblique", fmt::format("obliquely from {} and {}", below, front)}},
      {"ventral", {"from " + below, fmt::format("from {}{}", below, along)}},
      {"side", {"from " + left, fmt::format("from {}{}", left, along)}},
      {"cross-section", {"cut at x", fmt::format("cut across the middle, from {}", front)}},
      {"sagittal-section", {"cut at y", "cut along the middle" + along}}};
  for (View& view : views)
    if (const auto found = words.find(view.name); found != words.end())
      view.title = found->second[0], view.label = found->second[1];
}

EmbryoAxes picture_letters(const EmbryoAxes& axes) { return axes == plain_axes() ? EmbryoAxes{} : letters_of(axes); }

View cross_section_at(double x_um, const EmbryoAxes& axes) {
  View view = *std::ranges::find(views(), "cross-section", &View::name);
  view.name = fmt::format("x = {}{:.4g} µm", x_um < 0 ? "\u2212" : "", std::abs(x_um));
  view.label =
      fmt::format("cut across at {}, from {}", view.name, axes == anatomical_axes() ? "the front" : axes[0][0]);
  view.cut_um += x_um;
  return view;
}

}  // namespace plica
