// How results look, wherever they are shown (report, pictures, ParaView): which quantities colour an embryo, by what
// colours, and from where it is seen. The page of the report is told all this, so that it stands here only.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "tissue/files/frame_file.hpp"

namespace plica {

using Rgb = std::array<double, 3>;  // sRGB, 0 to 1

/// Colours at equal steps, from the least value to the greatest; between them, linear in sRGB.
struct ColourMap {
  std::string name;
  std::vector<Rgb> colours;
};

/// "still": lightness (CIE L*) falls evenly from cream to navy. "about": from blue over near white to brown, lightest
/// in the middle and even on both sides. Both read with any kind of colour vision; "still" in grey, too. "steps": a
/// colour a whole number.
const std::vector<ColourMap>& colour_maps();

enum class ScaleKind {
  from_zero,  // 0 to the greatest value
  about,      // the same distance on both sides of `centre`
  steps       // whole numbers
};

/// A quantity that colours the embryo.
struct ColourField {
  std::string name;   // as in `--colour`
  std::string label;  // "pressure"
  std::string unit;   // "Pa"; empty where there is none
  std::string array;  // of a frame: vectors of nodes, whose lengths it is, or numbers of cells
  bool on_nodes = false;
  ScaleKind kind = ScaleKind::from_zero;
  double centre = 0;
  [[nodiscard]] const ColourMap& map() const;
  [[nodiscard]] std::string title() const;  // "pressure, Pa"
};

/// displacement, speed, area-ratio, pressure, volume-error, volume, contraction, strength, generation,
/// region, self-intersections.
const std::vector<ColourField>& colour_fields();

/// These, and what a file has measured in the frame's cells: genes, say. Theirs is the name of the array.
std::vector<ColourField> fields_of(const Frame& frame);

/// Of a frame's arrays: 1 in the cells of the region whose name follows.
inline constexpr std::string_view region_prefix = "region_";

/// Names of a frame's regions.
std::vector<std::string> regions_of(const Frame& frame);

/// Those of them that hold some of the cells and not all. Coloured by region, a cell has the place from 1 of the
/// smallest of these that it is in; 0: none.
std::vector<std::string> coloured_regions(const Frame& frame);

/// The field's values of a frame: one a node where `on_nodes`, else one an element. FileError when the frame lacks the
/// array that they come from.
std::vector<double> field_values(const Frame& frame, const ColourField& field);

/// What the two ends of the colour scale stand for.
struct ColourRange {
  double low = 0, high = 1;
};

/// What the whole numbers of a field of steps stand for, from 0: "other cells" and the regions by name, no and yes, or
/// the numbers up to `largest`.
std::vector<std::string> step_names(const Frame& frame, const ColourField& field, double largest);

/// A scale of the field's kind that holds all values, ends rounded outwards to two digits at most. It has 0, unless it
/// is about another number.
ColourRange colour_range(const ColourField& field, double smallest, double largest);

/// The value's colour; values outside of the range have that of its nearer end.
Rgb colour_of(const ColourMap& map, const ColourRange& range, double value);

/// Where the views' planes cut: next to the middle, because the middle itself may hold whole walls of cells.
inline constexpr double view_cut_um = 0.01;

/// From where the embryo is seen, in parallel projection.
struct View {
  std::string name;             // as in `--view`
  std::string label;            // "from below, anterior to the left"
  Vec3 sight, up;               // from the eye into the picture, and what is upwards; of any length, not parallel
  std::optional<int> cut_axis;  // 0 or 1: what lies before a plane across this axis is taken away
  double cut_um = view_cut_um;  // where that plane is, from the origin
};

/// antero-ventral, ventral, side, cross-section, sagittal-section, apical.
const std::vector<View>& views();

/// The same of a tissue at rest, where `apical` looks against the mean normal of its apices. The first is the usual
/// one: antero-ventral, but of an open sheet `apical`.
std::vector<View> views_of(const Frame& rest);

/// The cross-section at another place along the embryo, called "x = 125 µm".
View cross_section_at(double x_um);

}  // namespace plica
