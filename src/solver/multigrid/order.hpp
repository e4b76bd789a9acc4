// Node order with small distances between neighbours, so that several products can follow one another through memory
// (smoother.hpp).
#pragma once

#include "solver/algebra/block_pattern.hpp"
#include "solver/algebra/rows.hpp"

namespace plica::multigrid {

/// Return the place of each node, sorted by distance (in neighbours) from a node at one end of the mesh: rings about
/// the axis of an embryo.
std::vector<int> places_by_distance(const BlockPattern& pattern);

/// Return the bounds of consecutive groups of at least `least` rows (fewer in the last), such that all columns of the
/// rows of a group lie in it or in the two adjacent groups. If neighbours are far apart, there are few groups.
std::vector<int> groups_of_rows(const Rows& matrix, int least);

}  // namespace plica::multigrid
