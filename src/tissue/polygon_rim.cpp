#include "tissue/polygon_rim.hpp"

#include <algorithm>
#include <map>

namespace plica {
namespace {

using Steps = std::map<NodeId, NodeId>;  // from a node to the next

// About the facets, counter-clockwise seen from above the apex.
Steps rim_of(std::span<const Facet> facets, CellSide side) {
  std::map<std::pair<NodeId, NodeId>, int> edges;
  for (const Facet& facet : facets)
    for (int i = 0; i < 4; ++i) {
      NodeId from = facet.nodes[i], to = facet.nodes[(i + 1) % 4];
      if (side == CellSide::basal) std::swap(from, to);
      ++edges[{from, to}];
    }
  Steps rim;
  for (const auto& [edge, count] : edges)
    if (!edges.contains({edge.second, edge.first})) rim[edge.first] = edge.second;
  return rim;
}

Steps upward(const Tissue& tissue, const Cell& cell) {
  Steps above;
  for (int e = 0; e < cell.element_count; ++e) {
    const auto& nodes = tissue.elements[cell.first_element.index() + static_cast<std::size_t>(e)];
    for (int i = 0; i < 4; ++i) above[nodes[i]] = nodes[i + 4];
  }
  return above;
}

// The free nodes from one to another; empty where the steps do not lead there.
std::vector<NodeId> chain(const Tissue& tissue, const Steps& steps, NodeId from, NodeId to) {
  std::vector<NodeId> nodes = {from};
  NodeId at = from;
  for (std::size_t count = 0; count < steps.size(); ++count) {
    const auto step = steps.find(at);
    if (step == steps.end()) return {};
    at = step->second;
    if (at == to || at.index() < tissue.free_node_count()) nodes.push_back(at);
    if (at == to) return nodes;
  }
  return {};
}

}  // namespace

std::optional<PolygonChains> chains_about(const Tissue& tissue, std::span<const Facet> basal,
                                          std::span<const Facet> apical, const Cell& cell) {
  PolygonChains chains;
  const std::size_t n = cell.sides();
  for (const CellSide side : {CellSide::basal, CellSide::apical}) {
    const auto corners = side == CellSide::apical ? cell.apical_corners() : cell.basal_corners();
    const Steps rim = rim_of(side == CellSide::apical ? apical : basal, side);
    for (std::size_t i = 0; i < n; ++i)
      (side == CellSide::apical ? chains.apical : chains.basal)
          .push_back(chain(tissue, rim, corners[i], corners[(i + 1) % n]));
  }
  const Steps above = upward(tissue, cell);
  for (std::size_t i = 0; i < n; ++i)
    chains.lateral.push_back(chain(tissue, above, cell.basal_corners()[i], cell.apical_corners()[i]));
  for (const auto* some : {&chains.basal, &chains.apical, &chains.lateral})
    for (const auto& one : *some)
      if (one.empty()) return std::nullopt;
  return chains;
}

}  // namespace plica
