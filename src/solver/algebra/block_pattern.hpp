// Where a sparse symmetric matrix of 3 x 3 blocks, one a node, has blocks.
#pragma once

#include <span>
#include <vector>

#include "solver/algebra/rows.hpp"

namespace plica {

/// The blocks on and below the diagonal; the last of a row is its diagonal's.
struct BlockPattern : Rows {
  [[nodiscard]] int nodes() const { return count(); }
  /// Number of the block at (row, column), column <= row; it must be there.
  [[nodiscard]] int find(int row, int column) const;
};

/// The pattern in which any two nodes of a group are neighbours; `groups` holds `group_size` nodes after another.
BlockPattern pattern_of_groups(int nodes, std::span<const int> groups, int group_size);

}  // namespace plica
