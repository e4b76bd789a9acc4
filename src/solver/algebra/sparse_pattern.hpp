// Sparsity pattern: columns of each row of a matrix, for node groups, factors and multigrid.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace plica {

/// Row n has the columns columns[starts[n]] to columns[starts[n + 1] - 1], ascending.
struct SparsePattern {
  std::vector<int> starts{0}, columns;

  [[nodiscard]] int count() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] std::span<const int> of(int row) const {
    return std::span(columns).subspan(starts[row], starts[row + 1] - starts[row]);
  }
  /// Return the index of (row, column) in `columns`; -1 if absent.
  [[nodiscard]] int place(int row, int column) const {
    const auto first = columns.begin() + starts[row], last = columns.begin() + starts[row + 1];
    const auto at = std::lower_bound(first, last, column);
    return at == last || *at != column ? -1 : static_cast<int>(at - columns.begin());
  }
};

/// Return the pattern of a symmetric matrix without its diagonal from the part on and below it.
SparsePattern neighbours_of(const SparsePattern& lower);

/// Return the position of each row in a nested-dissection elimination order. `lower`: pattern on and below, or below
/// the diagonal. Reproducible, also when called by several threads.
std::vector<int> elimination_order(const SparsePattern& lower);

/// Make rows by calls of take(column) in `visit(row, take)`, in any order, with repetitions allowed.
template <class Visit>
SparsePattern collect_pattern(int count, const Visit& visit) {
  SparsePattern rows;
  rows.starts.assign(count + 1, 0);
  for (const bool counting : {true, false}) {  // two passes, so that rows can be found on any thread
#pragma omp parallel
    {
      std::vector<int> found;  // few: linear search is faster than a set
#pragma omp for schedule(static)
      for (int row = 0; row < count; ++row) {
        found.clear();
        visit(row, [&](int column) {
          if (std::find(found.begin(), found.end(), column) == found.end()) found.push_back(column);
        });
        if (counting) {
          rows.starts[row + 1] = static_cast<int>(found.size());
        } else {
          std::sort(found.begin(), found.end());
          std::copy(found.begin(), found.end(), rows.columns.begin() + rows.starts[row]);
        }
      }
    }
    if (!counting) break;
    for (int row = 0; row < count; ++row) rows.starts[row + 1] += rows.starts[row];
    rows.columns.resize(rows.starts.back());
  }
  return rows;
}

/// Transpose: for each column its rows, and their indices in `rows.columns`.
struct Transposed {
  std::vector<int> starts, rows, places;
};
Transposed transpose(const SparsePattern& rows, int columns);

/// Sparsity pattern of a symmetric matrix of 3 x 3 blocks, one per node: blocks on and below the diagonal; the last
/// block of a row is diagonal.
struct BlockPattern : SparsePattern {
  [[nodiscard]] int nodes() const { return count(); }
  /// Return the index of the existing block (row, column), column <= row.
  [[nodiscard]] int find(int row, int column) const;
};

/// Return the pattern in which all nodes of a group are neighbours; `groups` lists `group_size` nodes per group.
BlockPattern pattern_of_groups(int nodes, std::span<const int> groups, int group_size);

}  // namespace plica
