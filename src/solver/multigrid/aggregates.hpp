// Which nodes become one of the next coarser level.
#pragma once

#include "solver/algebra/rows.hpp"

namespace plica::multigrid {

struct Aggregates {
  int count = 0;
  std::vector<int> of_node;  // -1: a node without neighbours, which needs no coarser level
  Rows members;              // of each aggregate
};

/// Disjoint neighbourhoods: a node with all its neighbours where none of them is taken yet; what is left over joins the
/// aggregate in which it has most neighbours. In a lattice of hexahedra 27 nodes, in a sheet of one layer 18.
Aggregates make_aggregates(const Rows& matrix);

}  // namespace plica::multigrid
