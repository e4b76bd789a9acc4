// Sparsity pattern of a symmetric matrix of 3 x 3 blocks, one per node.
#pragma once

#include <span>
#include <vector>

#include "solver/algebra/rows.hpp"

namespace plica {

/// Blocks on and below the diagonal; the last block of a row is diagonal.
struct BlockPattern : Rows {
  [[nodiscard]] int nodes() const { return count(); }
  /// Return the index of the existing block (row, column), column <= row.
  [[nodiscard]] int find(int row, int column) const;
};

/// Return the pattern in which all nodes of a group are neighbours; `groups` lists `group_size` nodes per group.
BlockPattern pattern_of_groups(int nodes, std::span<const int> groups, int group_size);

}  // namespace plica
