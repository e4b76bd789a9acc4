// Appearance of results in reports, pictures and ParaView: quantities for colouring, colour maps and views. The report
// page receives these definitions, so that they exist once.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "core/names.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/suggest.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

using Rgb = std::array<double, 3>;  // sRGB, 0 to 1

/// Colour map: colours at equal steps from the smallest to the largest value, interpolated linearly in sRGB.
struct ColourMap {
  std::string name;
  std::vector<Rgb> colours;
};

/// All colour maps. "still": lightness (CIE L*) decreases uniformly from cream to navy. "about": diverging, blue over
/// near white to brown. Both suit any kind of colour vision; "still" also greyscale. "steps": one colour per integer.
const std::vector<ColourMap>& colour_maps();

enum class ScaleKind {
  from_zero,  // 0 to the largest value
  about,      // symmetric about `centre`
  steps       // integers
};

struct ColourField {
  std::string name;   // as in `--color`
  std::string label;  // "pressure"
  std::string unit;   // "Pa"; empty for a pure number
  std::string array;  // array of a snapshot: node vectors (their norm is shown) or cell numbers
  bool on_nodes = false;
  ScaleKind kind = ScaleKind::from_zero;
  double centre = 0;
  [[nodiscard]] const ColourMap& map() const;
  [[nodiscard]] std::string title() const;  // "pressure, Pa"
};

/// Built-in quantities: displacement, speed, area-ratio, pressure, volume-error, volume, contraction, strength,
/// generation, region, self-intersections.
const std::vector<ColourField>& colour_fields();

/// Built-in quantities, signals, and measured cell data of an input file (genes, for example), named as their array.
std::vector<ColourField> fields_of(const Frame& frame);

/// Prefix of region arrays of a snapshot, followed by the region's name; 1 in its cells.
inline constexpr std::string_view region_prefix = "region_";

/// Names of the regions of a snapshot.
std::vector<std::string> regions_of(const Frame& frame);

/// Regions with some but not all cells. Coloured by region, a cell has the index (from 1) of the smallest of these that
/// contains it; 0: none.
std::vector<std::string> coloured_regions(const Frame& frame);

/// Array of a snapshot by name. Throws FileError if it is missing.
template <class Arrays>
const auto& values_in(const Arrays& arrays, const std::string& name) {
  const auto found = arrays.find(name);
  if (found == arrays.end())
    throw FileError(fmt::format("the snapshot has no array {}; give one written by plica", name));
  return found->second;
}

/// Values of a field in a snapshot: one per node if `on_nodes`, else one per element. Throws FileError for a missing
/// array.
std::vector<double> field_values(const Frame& frame, const ColourField& field);

/// Values at the ends of the colour scale.
struct ColourRange {
  double low = 0, high = 1;
};

/// Names of the integers of a field of steps, from 0: "other cells" and region names, no and yes, or the numbers up to
/// `largest`.
std::vector<std::string> step_names(const Frame& frame, const ColourField& field, double largest);

/// Range of the field's kind that includes all values, rounded outwards to at most two digits. Includes 0 unless
/// centred elsewhere.
ColourRange colour_range(const ColourField& field, double smallest, double largest);

/// Colour of a value, clamped to the range.
Rgb colour_of(const ColourMap& map, const ColourRange& range, double value);

/// Position of section planes: slightly off the centre, where lateral faces of cells may lie.
inline constexpr double view_cut_um = 0.01;

/// View of the embryo, in parallel projection.
struct View {
  std::string name;             // as in `--view`
  std::string label;            // "from below, anterior to the left"
  Vec3 sight, up;               // viewing direction and upward direction; any length, not parallel
  std::optional<int> cut_axis;  // 0 or 1: normal of a section plane, in front of which everything is removed
  double cut_um = view_cut_um;  // position of that plane from the origin
  std::string title = "";       // heading in pictures and reports; empty: the name
  [[nodiscard]] const std::string& heading() const { return title.empty() ? name : title; }
};

/// Built-in views: antero-ventral, ventral, side, cross-section, sagittal-section, apical.
const std::vector<View>& views();

/// Views of a tissue, with `apical` along its mean reference apical normal. The first is the default: antero-ventral,
/// or `apical` for an open sheet.
std::vector<View> views_of(const Frame& rest);

/// Adapt titles and labels of views to the axes: "from −z" for "ventral" of a tissue without a ventral side.
void name_views(std::vector<View>& views, const EmbryoAxes& axes);

/// Letters at the ends of a tissue in pictures; none for plain axes.
EmbryoAxes picture_letters(const EmbryoAxes& axes);

/// Cross-section at another position along the embryo, named "x = 125 µm".
View cross_section_at(double x_um, const EmbryoAxes& axes = anatomical_axes());

/// Find the view or quantity of a name. Throws UsageError that lists all names.
template <class Thing>
const Thing& named(const char* option, const std::string& name, const std::vector<Thing>& things) {
  const auto found = std::ranges::find(things, name, &Thing::name);
  if (found != things.end()) return *found;
  const std::vector<std::string> names = names_of(things);
  const auto nearest = nearest_name(name, names);
  throw UsageError(fmt::format("{} {}: unknown name; {}available: {}", option, name,
                               nearest ? fmt::format("use {} (nearest match); ", *nearest) : "",
                               fmt::join(names, ", ")));
}

}  // namespace plica
