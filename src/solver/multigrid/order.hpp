// Order of the nodes of a level with small distances between neighbours, so that several products can follow one
// another through memory (smoother.hpp), and their aggregation: groups that become one node of the next coarser level.
#pragma once

#include "solver/algebra/rows.hpp"

namespace plica::multigrid {

/// Return the place of each node, sorted by distance (in neighbours) from a node at one end of the mesh: rings about
/// the axis of an embryo.
std::vector<int> places_by_distance(const BlockPattern& pattern);

/// Return the bounds of consecutive groups of at least `least` rows (fewer in the last), such that all columns of the
/// rows of a group lie in it or in the two adjacent groups. If neighbours are far apart, there are few groups.
std::vector<int> groups_of_rows(const Rows& matrix, int least);

struct Aggregates {
  int count = 0;
  std::vector<int> of_node;  // -1: isolated node, omitted on the coarser level
  Rows members;              // nodes of each aggregate
};

/// Make disjoint neighbourhoods: a node with all its neighbours if none is taken yet; each remaining node joins the
/// aggregate with most of its neighbours. 27 nodes in a lattice of hexahedra, 18 in a sheet of one layer.
Aggregates make_aggregates(const Rows& matrix);

}  // namespace plica::multigrid
