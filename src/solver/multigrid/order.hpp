// An order of nodes in which neighbours are near each other, so that a few products can follow one another through
// memory (smoother.hpp).
#pragma once

#include "solver/algebra/block_pattern.hpp"
#include "solver/algebra/rows.hpp"

namespace plica::multigrid {

/// Each node's place when they are in the order of their distance, counted in neighbours, from a node at one end of the
/// mesh: rings about an embryo's axis.
std::vector<int> places_by_distance(const BlockPattern& pattern);

/// The bounds of groups of rows, one after another, each of at least `least` rows (the last may have less), such that
/// all columns of a group's rows are in it or in the two beside it. Where neighbours are far apart, these are few.
std::vector<int> groups_of_rows(const Rows& matrix, int least);

}  // namespace plica::multigrid
