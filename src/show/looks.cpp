#include "show/looks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "measure/cell_columns.hpp"
#include "show/boundary_surface.hpp"
#include "tissue/faces.hpp"
#include "tissue/hexahedron.hpp"

namespace plica {
namespace {

using Lab = std::array<double, 3>;  // CIE L*a*b*, white point D65

constexpr int colours_a_map = 33;

// IEC 61966-2-1 and CIE 15: Lab to XYZ to linear light to sRGB.
Rgb srgb_of(const Lab& lab) {
  const double fy = (lab[0] + 16) / 116;
  const std::array<double, 3> f = {fy + lab[1] / 500, fy, fy - lab[2] / 200}, white = {0.95047, 1, 1.08883};
  std::array<double, 3> xyz{};
  for (int i = 0; i < 3; ++i)
    xyz[i] = white[i] * (f[i] > 6.0 / 29 ? f[i] * f[i] * f[i] : 3 * (6.0 / 29) * (6.0 / 29) * (f[i] - 4.0 / 29));
  const std::array<double, 3> light = {3.2406 * xyz[0] - 1.5372 * xyz[1] - 0.4986 * xyz[2],
                                       -0.9689 * xyz[0] + 1.8758 * xyz[1] + 0.0415 * xyz[2],
                                       0.0557 * xyz[0] - 0.2040 * xyz[1] + 1.0570 * xyz[2]};
  Rgb rgb{};
  for (int i = 0; i < 3; ++i) {
    const double value = light[i] <= 0.0031308 ? 12.92 * light[i] : 1.055 * std::pow(light[i], 1 / 2.4) - 0.055;
    rgb[i] = std::clamp(value, 0.0, 1.0);
  }
  return rgb;
}

// Interpolate values at equal steps linearly at `part` (0 to 1).
template <class Values>
auto between(const Values& values, double part) {
  const double place = std::clamp(part, 0.0, 1.0) * static_cast<double>(values.size() - 1);
  const auto low = std::min(static_cast<std::size_t>(place), values.size() - 2);
  auto result = values[low];
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] += (place - static_cast<double>(low)) * (values[low + 1][i] - values[low][i]);
  return result;
}

ColourMap lab_map(const std::string& name, const std::vector<Lab>& control) {
  ColourMap map{name, {}};
  for (int i = 0; i < colours_a_map; ++i)
    map.colours.push_back(srgb_of(between(control, static_cast<double>(i) / (colours_a_map - 1))));
  return map;
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

template <class Arrays>
const auto& required(const Arrays& arrays, const std::string& name) {
  const auto found = arrays.find(name);
  if (found == arrays.end())
    throw FileError(fmt::format("the snapshot has no array {}; give one written by plica", name));
  return found->second;
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
  // Cells at rest are light. Rejected: viridis, whose yellow end becomes muddy in shade.
  static const std::vector<ColourMap> maps = {
      lab_map("still", {{96, -3, 10}, {78, -18, 2}, {59, -20, -18}, {40, -4, -33}, {21, 8, -30}}),
      lab_map("about", {{25, 8, -38}, {60, -10, -32}, {95, 0, 3}, {60, 22, 42}, {25, 24, 32}}),
      // Okabe and Ito's colours for any kind of colour vision, light ones first.
      {"steps",
       {{0.90, 0.90, 0.88},
        {0.90, 0.62, 0},
        {0.34, 0.71, 0.91},
        {0, 0.62, 0.45},
        {0.80, 0.47, 0.65},
        {0.84, 0.37, 0}}}};
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
    if (!is_plicas(name) && std::ranges::find(plicas, name) == plicas.end()) fields.push_back({name, name, "", name});
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
  if (!field.on_nodes) return required(frame.element_scalars, field.array);
  const Vectors& vectors = required(frame.node_vectors, field.array);
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
  return between(map.colours, (value - range.low) / (range.high - range.low));
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
  for (const auto& element : rest.elements) {
    std::array<Vec3, 4> apex;
    for (int i = 0; i < 4; ++i) apex[i] = rest.positions[element[hex_faces[apical_face][i]].index()];
    facing.add(apex);
  }
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
