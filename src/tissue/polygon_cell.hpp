// What follows from a polygonal cell's elements and corners.
#pragma once

#include "tissue/tissue.hpp"

namespace plica {

/// Sets edges, lines and rest shape of a cell whose elements, facets and corners are there: an edge is the chain of
/// free nodes from a corner to the next. `basal` and `apical` are the cell's facets; of each element, nodes 4-7 lie
/// above 0-3. False when there are no such chains: corners are not on the rim of the facets, in its order, or not above
/// each other.
bool complete_polygon(const Tissue& tissue, std::span<const Facet> basal, std::span<const Facet> apical, Cell& cell);

}  // namespace plica
