// The outline of a cell that is given by its elements and corners alone.
#pragma once

#include <optional>
#include <span>

#include "tissue/polygon_cell.hpp"

namespace plica {

/// The chains of free nodes from a corner to the next, on both faces, and up from each. `basal` and `apical` are the
/// cell's facets; of each element, nodes 4-7 lie above 0-3. Nothing when there are no such chains: corners are not on
/// the rim of the facets, in its order, or not above each other.
std::optional<PolygonChains> chains_about(const Tissue& tissue, std::span<const Facet> basal,
                                          std::span<const Facet> apical, const Cell& cell);

}  // namespace plica
