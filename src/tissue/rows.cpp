#include "tissue/rows.hpp"

#include <algorithm>
#include <limits>

#include "tissue/faces.hpp"

namespace plica {
namespace {

constexpr double nothing_um = 1e-6;  // rounding

// 0 of a cell that the midline cuts, 1 of one that it runs along, else -1.
int start_at_midline(const Tissue& tissue, const Cell& cell, bool has_back) {
  double low = std::numeric_limits<double>::infinity(), high = -low, height = 0;
  int on_it = 0;
  for (const NodeId corner : cell.apical_corners()) {
    const Vec3& x = tissue.rest_positions[corner.index()];
    low = std::min(low, x.y());
    high = std::max(high, x.y());
    height += x.z();
    on_it += static_cast<int>(std::abs(x.y()) < nothing_um);
  }
  if (has_back && height >= 0) return -1;
  if (low < -nothing_um && high > nothing_um) return 0;
  return on_it > 1 ? 1 : -1;
}

// Propagate given numbers, adding `step` through every lateral face, up to `most`.
void spread(const Tissue& tissue, int step, int most, std::vector<int>& numbers) {
  const std::vector<std::vector<CellId>> neighbours = wall_neighbours(tissue);
  std::vector<std::size_t> front;
  for (std::size_t c = 0; c < numbers.size(); ++c)
    if (numbers[c] >= 0) front.push_back(c);
  std::ranges::stable_sort(front, {}, [&](std::size_t c) { return numbers[c]; });
  for (std::size_t i = 0; i < front.size(); ++i) {
    const int next = numbers[front[i]] + step;
    if (next > most) continue;
    for (const CellId cell : neighbours[front[i]]) {
      int& number = numbers[cell.index()];
      if (number >= 0 && number <= next) continue;
      number = next;
      front.push_back(cell.index());
    }
  }
}

}  // namespace

std::vector<int> half_cells_from_midline(const Tissue& tissue) {
  std::vector<int> numbers;
  const bool has_back = goes_round(tissue);
  for (const Cell& cell : tissue.cells) numbers.push_back(start_at_midline(tissue, cell, has_back));
  spread(tissue, 2, std::numeric_limits<int>::max() - 2, numbers);
  return numbers;
}

CellSet cells_around(const Tissue& tissue, const CellSet& cells, int rings) {
  std::vector<int> numbers;
  for (const bool is_in : cells) numbers.push_back(is_in ? 0 : -1);
  spread(tissue, 1, rings, numbers);
  CellSet around(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) around[c] = numbers[c] > 0;
  return around;
}

}  // namespace plica
