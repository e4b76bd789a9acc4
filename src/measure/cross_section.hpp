// Cuts of the apical surface by planes, the basis of the furrow measures (instead of nearest nodes), and
// cross-sections: rings of cells numbered from the midline, and shapes of their apical surfaces.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Material point: weighted mean of four nodes.
struct MaterialPoint {
  std::array<NodeId, 4> nodes;
  std::array<double, 4> weights = {0, 0, 0, 0};

  [[nodiscard]] Vec3 at(std::span<const Vec3> positions) const;
};

/// Material point on an apical facet.
struct SurfacePoint : MaterialPoint {
  std::size_t facet = 0;  // index among the apical facets
};

/// Cut the apical facets with `wanted` by the plane `axis` = 0: points on their edges and on the lines from corners to
/// centre, facet by facet. A point on a shared edge occurs twice.
std::vector<SurfacePoint> cut_apical_surface(const Tissue& tissue, std::span<const Vec3> positions, int axis,
                                             const std::vector<bool>& wanted);

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
