#include "solver/multigrid/aggregates.hpp"

#include <utility>

namespace plica::multigrid {
namespace {

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
