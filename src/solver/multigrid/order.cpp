#include "solver/multigrid/order.hpp"

namespace plica::multigrid {
namespace {

// Appends the nodes that can be reached from the first, by their distance.
void walk(const Rows& neighbours, int first, std::vector<char>& seen, std::vector<int>& order) {
  std::size_t next = order.size();
  order.push_back(first);
  for (seen[first] = 1; next < order.size(); ++next)
    for (const int node : neighbours.of(order[next])) {
      if (seen[node]) continue;
      seen[node] = 1;
      order.push_back(node);
    }
}

}  // namespace

std::vector<int> places_by_distance(const BlockPattern& pattern) {
  const Rows neighbours = neighbours_of(pattern);
  std::vector<int> order, places(pattern.nodes());
  std::vector<char> seen(pattern.nodes(), 0);
  for (int node = 0; node < pattern.nodes(); ++node) {
    if (seen[node]) continue;
    const std::size_t begin = order.size();
    walk(neighbours, node, seen, order);
    const int end = order.back();  // the farthest is at an end; from there once more
    for (std::size_t k = begin; k < order.size(); ++k) seen[order[k]] = 0;
    order.resize(begin);
    walk(neighbours, end, seen, order);
  }
  for (int place = 0; place < pattern.nodes(); ++place) places[order[place]] = place;
  return places;
}

std::vector<int> groups_of_rows(const Rows& matrix, int least) {
  std::vector<int> bounds{0};
  int row = 0, reach = 0;  // of the rows before it
  while (bounds.back() < matrix.count()) {
    bounds.push_back(std::min(matrix.count(), std::max(reach, bounds.back() + least)));
    for (; row < bounds.back(); ++row)
      if (!matrix.of(row).empty()) reach = std::max(reach, matrix.of(row).back() + 1);
  }
  return bounds;
}

}  // namespace plica::multigrid
