// Self-intersections of a surface: pairs of facets that cross.
#pragma once

#include <cstddef>
#include <span>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Pairs of facets (indices into `facets`, lower first, in order) that cross at the given positions. A facet is four
/// triangles from its edges to the mean of its corners. Facets with a common node never count, nor do touching ones:
/// two triangles must penetrate by more than 1e-9 of the facet size. Cost: n log n (boxes sorted along one axis) plus
/// pairs of overlapping boxes.
std::vector<std::pair<std::size_t, std::size_t>> crossing_facets(std::span<const Facet> facets,
                                                                 std::span<const Vec3> positions);

/// Number of crossing pairs of apical and of basal facets.
std::size_t self_intersections(const Tissue& tissue, std::span<const Vec3> positions);

/// Cells with a facet that crosses another of its surface.
CellSet self_intersecting_cells(const Tissue& tissue, std::span<const Vec3> positions);

}  // namespace plica
