#include "solver/algebra/block_pattern.hpp"

#include <algorithm>
#include <stdexcept>

namespace plica {

int BlockPattern::find(int row, int column) const {
  const int at = place(row, column);
  if (at < 0) throw std::out_of_range("no such block in the pattern");
  return at;
}

BlockPattern pattern_of_groups(int nodes, std::span<const int> groups, int group_size) {
  std::vector<std::vector<int>> below(nodes);
  for (int n = 0; n < nodes; ++n) below[n].push_back(n);
  for (std::size_t g = 0; g < groups.size(); g += group_size)
    for (int a = 0; a < group_size; ++a)
      for (int b = 0; b < group_size; ++b)
        if (groups[g + b] < groups[g + a]) below[groups[g + a]].push_back(groups[g + b]);
  BlockPattern pattern;
  for (auto& row : below) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    pattern.columns.insert(pattern.columns.end(), row.begin(), row.end());
    pattern.starts.push_back(static_cast<int>(pattern.columns.size()));
  }
  return pattern;
}

}  // namespace plica
