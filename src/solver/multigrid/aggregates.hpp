// Aggregation: groups of nodes that become one node of the next coarser level.
#pragma once

#include "solver/algebra/rows.hpp"

namespace plica::multigrid {

struct Aggregates {
  int count = 0;
  std::vector<int> of_node;  // -1: isolated node, omitted on the coarser level
  Rows members;              // nodes of each aggregate
};

/// Make disjoint neighbourhoods: a node with all its neighbours if none is taken yet; each remaining node joins the
/// aggregate with most of its neighbours. 27 nodes in a lattice of hexahedra, 18 in a sheet of one layer.
Aggregates make_aggregates(const Rows& matrix);

}  // namespace plica::multigrid
