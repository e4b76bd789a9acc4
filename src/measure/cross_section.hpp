// Cross-sections: rings of cells numbered from the midline, and shapes of their apical surfaces.
#pragma once

#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Cell of a cross-section.
struct SectionCell {
  CellId cell;
  int place_percent = 50;  // reference position of the section, % of the length from the anterior end
  int from_midline = 0;    // 1, 2, ... to the right (y > 0), -1, -2, ... to the left; 0 on the midline
};

/// Cells of the sections at 50, 25 and 75 % of the length, each from left to right: cells whose reference apical faces
/// meet a plane just behind the position, ordered by angle about the axis from the midline on the side of `outward`.
/// Equal sections of a short tissue are listed once.
std::vector<SectionCell> section_cells(const Tissue& tissue, const Vec3& outward);

/// Shape of an apical surface: rectangle with the same second moments of area.
struct FaceShape {
  double long_axis_um = 0, short_axis_um = 0;
  double direction_deg = 0;    // of the long axis: 0 along the embryo's axis, 90 across
  double length_along_um = 0;  // along the embryo's axis
  double width_across_um = 0;  // across the axis
};

/// Shapes of the apical surfaces; cells. NaN at a pole or for a vanished apical surface.
std::vector<FaceShape> apical_shapes(const Tissue& tissue, std::span<const CellId> cells,
                                     std::span<const Vec3> positions);

}  // namespace plica
