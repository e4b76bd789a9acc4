// The apical surface cut by a plane: how the furrow's geometry is read, never off nearest nodes.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// A point that moves with the tissue: a weighted mean of four nodes.
struct MaterialPoint {
  std::array<NodeId, 4> nodes;
  std::array<double, 4> weights = {0, 0, 0, 0};

  [[nodiscard]] Vec3 at(std::span<const Vec3> positions) const;
};

/// A material point on an apical facet.
struct SurfacePoint : MaterialPoint {
  std::size_t facet = 0;  // among the apical facets
};

/// Where the plane `axis` = 0 cuts the apical facets for which `wanted` is true: the points on their edges and on the
/// lines from their corners to their middle, a facet after the other. A point on an edge of two facets comes twice.
std::vector<SurfacePoint> cut_apical_surface(const Tissue& tissue, std::span<const Vec3> positions, int axis,
                                             const std::vector<bool>& wanted);

}  // namespace plica
