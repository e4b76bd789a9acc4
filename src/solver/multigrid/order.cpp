#include "solver/multigrid/order.hpp"

#include <algorithm>
#include <utility>

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

// The aggregate in which most of the neighbours are; the lowest where it is a tie.
int most_frequent(std::span<const int> neighbours, const std::vector<int>& aggregate_of) {
  std::vector<std::pair<int, int>> counts;
  for (const int n : neighbours) {
    if (aggregate_of[n] == -1) continue;
    const auto found =
        std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == aggregate_of[n]; });
    if (found == counts.end())
      counts.emplace_back(aggregate_of[n], 1);
    else
      ++found->second;
  }
  int best = -1, most = 0;
  for (const auto& [aggregate, count] : counts)
    if (count > most || (count == most && aggregate < best)) {
      best = aggregate;
      most = count;
    }
  return best;
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

Aggregates make_aggregates(const Rows& matrix) {
  Aggregates result;
  std::vector<int> first(matrix.count(), -1);
  for (int node = 0; node < matrix.count(); ++node) {
    const auto neighbours = matrix.of(node);  // itself among them
    const bool free = std::all_of(neighbours.begin(), neighbours.end(), [&](int n) { return first[n] == -1; });
    if (!free || neighbours.size() < 2) continue;
    for (const int n : neighbours) first[n] = result.count;
    ++result.count;
  }
  result.of_node = first;
  for (int node = 0; node < matrix.count(); ++node)
    if (first[node] == -1) result.of_node[node] = most_frequent(matrix.of(node), first);

  Rows of_nodes;
  for (const int aggregate : result.of_node) {
    if (aggregate != -1) of_nodes.columns.push_back(aggregate);
    of_nodes.starts.push_back(static_cast<int>(of_nodes.columns.size()));
  }
  Transposed members = transpose(of_nodes, result.count);
  result.members = {std::move(members.starts), std::move(members.rows)};
  return result;
}

}  // namespace plica::multigrid
