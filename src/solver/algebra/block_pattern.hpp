// Where a sparse symmetric matrix of 3 x 3 blocks, one a node, has blocks.
#pragma once

#include <span>
#include <vector>

namespace plica {

/// Places of the blocks of a symmetric matrix, diagonal and below, by rows: those of row n are columns[starts[n]] to
/// columns[starts[n + 1] - 1], ascending, the last being n itself.
struct BlockPattern {
  std::vector<int> starts, columns;
  [[nodiscard]] int nodes() const { return static_cast<int>(starts.size()) - 1; }
  /// Number of the block at (row, column), column <= row; it must be there.
  [[nodiscard]] int find(int row, int column) const;
};

/// The pattern in which any two nodes of a group are neighbours; `groups` holds `group_size` nodes after another.
BlockPattern pattern_of_groups(int nodes, std::span<const int> groups, int group_size);

}  // namespace plica
