#include "solver/multigrid/rows.hpp"

namespace plica::multigrid {

Transposed transpose(const Rows& rows, int columns) {
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

}  // namespace plica::multigrid
