#include "mechanics/contact/nonconforming_edges.hpp"

#include <array>
#include <cmath>

namespace plica {

NonconformingEdges::NonconformingEdges(const Tissue& tissue, const std::map<Edge, std::size_t>& edges) {
  for (const auto& [edge, facet] : edges)
    if (!edges.contains({edge.second, edge.first}))
      if (const std::optional<Part> part = part_of(tissue, edge, facet)) lines_[part->line].push_back(*part);
  for (const auto& [line, parts] : lines_)
    for (const Part& part : parts)
      for (const Part& other : parts) {
        if (part.is_forward() == other.is_forward()) continue;
        inner_.insert(part.edge);
        add_end(part, other.edge.first, other.from);
        add_end(part, other.edge.second, other.to);
      }
}

void NonconformingEdges::add_end(const Part& part, NodeId node, double place) {
  if (!part.holds(place)) return;
  across_[node].insert(part.facet);
  lying_[std::minmax(part.edge.first, part.edge.second)].insert(node);
}

std::optional<NonconformingEdges::Part> NonconformingEdges::part_of(const Tissue& tissue, const Edge& edge,
                                                                    std::size_t facet) {
  std::map<NodeId, std::array<double, 2>> weights;  // of free nodes in both ends
  tissue.for_free_nodes(edge.first, [&](NodeId node, double weight) { weights[node][0] += weight; });
  tissue.for_free_nodes(edge.second, [&](NodeId node, double weight) { weights[node][1] += weight; });
  constexpr double rounding = 1e-9;
  const auto changes = [](const auto& one) { return std::abs(one.second[1] - one.second[0]) > rounding; };
  const auto first = std::ranges::find_if(weights, changes);
  if (first == weights.end()) return std::nullopt;
  const auto [from, to] = first->second;
  Part part{{}, from, to, edge, facet};
  for (const auto& [node, ends] : weights) {
    const double slope = (ends[1] - ends[0]) / (to - from);
    part.line.emplace_back(node, std::llround(slope / rounding), std::llround((ends[0] - slope * from) / rounding));
  }
  std::erase_if(part.line, [](const auto& one) { return std::get<1>(one) == 0 && std::get<2>(one) == 0; });
  return part;
}

}  // namespace plica
