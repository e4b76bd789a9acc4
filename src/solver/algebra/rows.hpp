// THE sparse pattern: which columns each row of a matrix has. Groups of nodes, factors and the multigrid all have it.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

namespace plica {

/// Row n has the columns columns[starts[n]] to columns[starts[n + 1] - 1], ascending.
struct Rows {
  std::vector<int> starts{0}, columns;

  [[nodiscard]] int count() const { return static_cast<int>(starts.size()) - 1; }
  [[nodiscard]] std::span<const int> of(int row) const {
    return std::span(columns).subspan(starts[row], starts[row + 1] - starts[row]);
  }
  /// The place of (row, column) in `columns`; -1 where it is not there.
  [[nodiscard]] int place(int row, int column) const {
    const auto first = columns.begin() + starts[row], last = columns.begin() + starts[row + 1];
    const auto at = std::lower_bound(first, last, column);
    return at == last || *at != column ? -1 : static_cast<int>(at - columns.begin());
  }
};

/// The pattern of the whole of a symmetric matrix without its diagonal, from that on and below it.
Rows neighbours_of(const Rows& lower);

/// The order in which a symmetric matrix is best eliminated (nested dissection): the place of each row in it. `lower`:
/// its pattern on and below the diagonal, or below. The same on every call, also of several threads at once.
std::vector<int> elimination_order(const Rows& lower);

/// The rows that `visit(row, take)` makes by calling take(column), in any order and as often as it likes.
template <class Visit>
Rows collect_rows(int count, const Visit& visit) {
  Rows rows;
  rows.starts.assign(count + 1, 0);
  for (const bool counting : {true, false}) {  // the same walk twice, so that rows are found on any thread
#pragma omp parallel
    {
      std::vector<int> found;  // few: looked through faster than any set
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

/// The other way round: for each column the rows that have it, and where in `rows.columns`.
struct Transposed {
  std::vector<int> starts, rows, places;
};
Transposed transpose(const Rows& rows, int columns);

}  // namespace plica
