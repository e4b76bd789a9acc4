// Whether a surface passes through itself: pairs of its facets that cross.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Pairs of facets (places among `facets`, the lower first, in order) that cross at the given positions. A facet is the
/// four triangles from its edges to the mean of its corners. Facets with a common node are never a pair, and what only
/// touches does not cross: two triangles have to reach through each other by more than 1e-9 of the facets' size. Boxes
/// are sorted along one axis, then pairs of triangles are tried: n log n and the pairs whose boxes overlap.
std::vector<std::pair<std::size_t, std::size_t>> crossing_facets(std::span<const Facet> facets,
                                                                 std::span<const Vec3> positions);

/// How many pairs cross, of apical facets and of basal ones.
std::size_t self_intersections(const Tissue& tissue, std::span<const Vec3> positions);

/// Cells with a facet that crosses another one of its surface.
CellSet self_intersecting_cells(const Tissue& tissue, std::span<const Vec3> positions);

}  // namespace plica
