// A part of a tissue: some of its cells, with all nodes as they were.
#pragma once

#include "tissue/division.hpp"

namespace plica {

/// Leaves only the given cells, with their elements and facets; nodes stay, used or not. What is kept by cell is handed
/// on by the result as after a division.
Division keep_only(Tissue& tissue, const CellSet& cells);

/// Leaves out nodes that no element has. Where the others were, in their order: new node to old.
std::vector<NodeId> drop_unused_nodes(Tissue& tissue);

}  // namespace plica
