// Outline of a cell given by its elements and corners only.
#pragma once

#include <optional>
#include <span>

#include "tissue/polygon_cell.hpp"

namespace plica {

/// Return the chains of free nodes between corners on both faces, and up from each corner. `basal` and `apical` are the
/// facets of the cell; nodes 4-7 of each element lie above 0-3. Empty if there are none: corners are not on the
/// boundary of the facets, in its order, or not above each other.
std::optional<PolygonChains> chains_about(const Tissue& tissue, std::span<const Facet> basal,
                                          std::span<const Facet> apical, const Cell& cell);

}  // namespace plica
