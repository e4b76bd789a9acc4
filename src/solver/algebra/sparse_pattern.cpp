#include "solver/algebra/sparse_pattern.hpp"

#include <metis.h>

#include <csignal>
#include <mutex>
#include <new>
#include <numeric>
#include <stdexcept>

namespace plica {

SparsePattern neighbours_of(const SparsePattern& lower) {
  SparsePattern neighbours{std::vector<int>(lower.starts.size(), 0), {}};
  const auto for_pairs = [&](const auto& take) {
    for (int row = 0; row < lower.count(); ++row)
      for (const int column : lower.of(row))
        if (column != row) take(row, column), take(column, row);
  };
  for_pairs([&](int row, int) { ++neighbours.starts[row + 1]; });
  std::partial_sum(neighbours.starts.begin(), neighbours.starts.end(), neighbours.starts.begin());
  neighbours.columns.resize(neighbours.starts.back());
  std::vector<int> next(neighbours.starts.begin(), neighbours.starts.end() - 1);
  for_pairs([&](int row, int column) { neighbours.columns[next[row]++] = column; });
  return neighbours;
}

std::vector<int> elimination_order(const SparsePattern& lower) {
  const SparsePattern neighbours = neighbours_of(lower);
  idx_t size = lower.count();
  std::vector<idx_t> starts(neighbours.starts.begin(), neighbours.starts.end());
  std::vector<idx_t> adjacent(neighbours.columns.begin(), neighbours.columns.end());
  std::vector<int> order(size);
  std::iota(order.begin(), order.end(), 0);
  if (adjacent.empty()) return order;  // METIS wants an edge
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  std::vector<idx_t> rows(size), places(size);
  static std::mutex one_at_a_time;  // METIS draws from the C library's one sequence of random numbers
  const std::lock_guard lock(one_at_a_time);
  const auto order_them = [&] {
    return METIS_NodeND(&size, starts.data(), adjacent.data(), nullptr, options, rows.data(), places.data());
  };
  int result = order_them();
  if (result == METIS_ERROR) {
    // While METIS works, it takes SIGTERM for an error of its own. If it succeeds now, the signal came from outside.
    result = order_them();
    if (result == METIS_OK) std::raise(SIGTERM);
  }
  if (result == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (result != METIS_OK) throw std::runtime_error("METIS could not order the matrix");
  return {places.begin(), places.end()};
}

Transposed transpose(const SparsePattern& rows, int columns) {
  Transposed result;
  result.starts.assign(columns + 1, 0);
  for (const int column : rows.columns) ++result.starts[column + 1];
  for (int column = 0; column < columns; ++column) result.starts[column + 1] += result.starts[column];
  result.rows.resize(rows.columns.size());
  result.places.resize(rows.columns.size());
  std::vector<int> next(result.starts.begin(), result.starts.end() - 1);
  for (int row = 0; row < rows.count(); ++row)
    for (int place = rows.starts[row]; place < rows.starts[row + 1]; ++place) {
      const int at = next[rows.columns[place]]++;
      result.rows[at] = row;
      result.places[at] = place;
    }
  return result;
}

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
