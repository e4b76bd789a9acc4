// Part of a tissue: some of its cells, with unchanged nodes.
#pragma once

#include "tissue/division.hpp"

namespace plica {

/// Keep only the given cells, with their elements and facets; nodes stay, used or not. The result maps data per cell,
/// as after a division.
Division keep_only(Tissue& tissue, const CellSet& cells);

/// Remove nodes without elements. Return former node numbers: new node to old.
std::vector<NodeId> drop_unused_nodes(Tissue& tissue);

}  // namespace plica
