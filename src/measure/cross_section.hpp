// Rings of cells around the embryo, each cell by its number from the midline, and the shapes of their apices.
#pragma once

#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// A cell of a cross-section.
struct SectionCell {
  CellId cell;
  int place_percent = 50;  // where the section is, of the embryo's length at rest, from its anterior end
  int from_midline = 0;    // 1, 2, ... to the right (y > 0), -1, -2, ... to the left; 0 lies on the midline
};

/// Those of the sections at 25, 50 and 75 % of the length, the middle first, each from left to right: the cells whose
/// apical faces a plane just behind the place meets at rest, in the order of their angles about the axis, from the
/// midline of the side towards `outward`. Of a tissue so short that sections are the same, the first of them.
std::vector<SectionCell> section_cells(const Tissue& tissue, const Vec3& outward);

/// The shape of a cell's apex: of the rectangle whose area has the same second moments.
struct FaceShape {
  double long_axis_um = 0, short_axis_um = 0;
  double direction_deg = 0;    // of the long axis: 0 along the embryo's axis, 90 across
  double length_along_um = 0;  // along the embryo's axis
  double width_across_um = 0;  // across it
};

/// Of each of these cells. NaN where the apex is flat on the embryo's axis (at a pole) or gone.
std::vector<FaceShape> apical_shapes(const Tissue& tissue, std::span<const CellId> cells,
                                     std::span<const Vec3> positions);

}  // namespace plica
