// Cut of the apical surface by a plane; basis of the furrow measures (instead of nearest nodes).
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

}  // namespace plica
