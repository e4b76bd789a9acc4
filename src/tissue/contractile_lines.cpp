#include "tissue/contractile_lines.hpp"

#include <algorithm>
#include <map>

#include "tissue/polygon_cell.hpp"

namespace plica {
namespace {

using Lines = std::vector<ContractileLine>;

Lines lines_of_face(const Cell& cell, CellSide side) {
  Lines lines;
  for (const auto& [chain, share] : cell.lines)
    if (chain.side == side) lines.push_back({chain.nodes, chain.direction, chain.along, share});
  return lines;
}

// From the base to the apex above each node of the basal edges, corners first.
Lines lines_of_walls(const Tissue& tissue, const Cell& cell) {
  std::map<NodeId, NodeId> above;
  for (int e = 0; e < cell.element_count; ++e) {
    const auto& element = tissue.elements[cell.first_element.index() + static_cast<std::size_t>(e)];
    for (int i = 0; i < 4; ++i) above[element[i]] = element[i + 4];
  }
  Lines lines;
  std::map<NodeId, std::size_t> line_from;
  const auto line_at = [&](NodeId node) -> ContractileLine& {
    const auto [known, is_new] = line_from.try_emplace(node, lines.size());
    if (!is_new) return lines[known->second];
    ContractileLine& line = lines.emplace_back(ContractileLine{{node}, EdgeDirection::lateral, 0, 0});
    for (auto next = above.find(node); next != above.end(); next = above.find(next->second))
      line.nodes.push_back(next->second);
    return line;
  };
  for (const NodeId corner : cell.basal_corners()) line_at(corner);
  for (const CellEdge& edge : cell.edges) {
    if (edge.side != CellSide::basal) continue;
    const double share = 1 / static_cast<double>(edge.nodes.size() - 1);
    for (std::size_t i = 0; i < edge.nodes.size(); ++i)
      line_at(edge.nodes[i]).share += i == 0 || i + 1 == edge.nodes.size() ? 0.5 * share : share;
  }
  return lines;
}

// The element edges of the face of a polygon, by the number of its quadrilaterals that each belongs to.
Lines net_of_face(const Tissue& tissue, const Cell& cell, CellSide side, std::span<const Facet> facets) {
  const auto way = [&](NodeId from, NodeId to) {
    return Vec3(tissue.rest_positions[to.index()] - tissue.rest_positions[from.index()]);
  };
  // Sums of the lengths, and of their squares, of the edges and of the net: these squares are as the energies of
  // springs of one stiffness, the lengths as those of one tension.
  double edges = 0, edges_squared = 0, net = 0, net_squared = 0;
  for (const CellEdge& edge : cell.edges) {
    if (edge.side != side) continue;
    double length = 0;
    for (std::size_t i = 1; i < edge.nodes.size(); ++i) length += way(edge.nodes[i - 1], edge.nodes[i]).norm();
    edges += length;
    edges_squared += length * length;
  }
  std::map<std::pair<NodeId, NodeId>, int> uses;
  for (const Facet& facet : facets)
    for (int i = 0; i < 4; ++i) {
      const NodeId from = facet.nodes[i], to = facet.nodes[(i + 1) % 4];
      ++uses[std::minmax(from, to)];
      net += way(from, to).norm();
      net_squared += way(from, to).squaredNorm();
    }
  const double tension = edges / net, stiffness = edges_squared / net_squared;
  Lines lines;
  for (const auto& [ends, count] : uses) {
    const double along = alignment_with_x(way(ends.first, ends.second), outward_of(cell, tissue.rest_positions));
    lines.push_back({.nodes = {ends.first, ends.second},
                     .direction = along < 0.5 ? EdgeDirection::across : EdgeDirection::along,
                     .along = along,
                     .share = count * tension,
                     .in_series = stiffness / tension});
  }
  return lines;
}

}  // namespace

std::vector<std::vector<ContractileLine>> contractile_lines(const Tissue& tissue, CellSide side) {
  std::vector<Lines> lines;
  if (side == CellSide::lateral) {
    for (const Cell& cell : tissue.cells) lines.push_back(lines_of_walls(tissue, cell));
    return lines;
  }
  for (const Cell& cell : tissue.cells) lines.push_back(lines_of_face(cell, side));
  const std::vector<bool> is_inner = inner_nodes_of_polygons(tissue);
  const std::span<const Facet> facets = side == CellSide::apical ? tissue.apical_facets : tissue.basal_facets;
  for (std::size_t begin = 0, end = 0; begin < facets.size(); begin = end) {
    const CellId cell = facets[begin].cell;
    bool has_inner = false;
    for (; end < facets.size() && facets[end].cell == cell; ++end)
      has_inner |= std::ranges::any_of(facets[end].nodes, [&](NodeId node) { return is_inner[node.index()]; });
    if (has_inner)
      lines[cell.index()] = net_of_face(tissue, tissue.cells[cell.index()], side, facets.subspan(begin, end - begin));
  }
  return lines;
}

}  // namespace plica
