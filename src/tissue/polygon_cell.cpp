#include "tissue/polygon_cell.hpp"

#include <algorithm>

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

// Counter-clockwise about the cell, as a unit vector.
Vec3 outward(const Tissue& tissue, const Cell& cell) {
  Vec3 sum = Vec3::Zero();
  const auto corners = cell.apical_corners();
  for (std::size_t i = 0; i < corners.size(); ++i)
    sum += tissue.rest_positions[corners[i].index()].cross(
        tissue.rest_positions[corners[(i + 1) % corners.size()].index()]);
  return sum.normalized();
}

void set_direction(const Tissue& tissue, const Vec3& axis, CellEdge& edge) {
  const Vec3 way = tissue.rest_positions[edge.nodes.back().index()] - tissue.rest_positions[edge.nodes[0].index()];
  // At a pole, nothing is along more than across.
  edge.along = axis.norm() < 1e-6
                   ? 0.5
                   : std::min(1.0, way.dot(axis) * way.dot(axis) / (way.squaredNorm() * axis.squaredNorm()));
  edge.direction = edge.along < 0.5 ? EdgeDirection::across : EdgeDirection::along;
}

}  // namespace

bool complete_polygon(const Tissue& tissue, std::span<const Facet> basal, std::span<const Facet> apical, Cell& cell) {
  const std::size_t n = cell.sides();
  const Vec3 normal = outward(tissue, cell), axis = Vec3::UnitX() - normal.x() * normal;
  for (const CellSide side : {CellSide::basal, CellSide::apical}) {
    const auto corners = side == CellSide::apical ? cell.apical_corners() : cell.basal_corners();
    const Steps rim = rim_of(side == CellSide::apical ? apical : basal, side);
    for (std::size_t i = 0; i < n; ++i) {
      CellEdge edge{chain(tissue, rim, corners[i], corners[(i + 1) % n]), EdgeDirection::along, side};
      if (edge.nodes.empty()) return false;
      set_direction(tissue, axis, edge);
      cell.edges.push_back(std::move(edge));
    }
  }
  const Steps above = upward(tissue, cell);
  for (std::size_t i = 0; i < n; ++i) {
    CellEdge edge{chain(tissue, above, cell.basal_corners()[i], cell.apical_corners()[i]), EdgeDirection::lateral,
                  CellSide::lateral};
    if (edge.nodes.empty()) return false;
    cell.edges.push_back(std::move(edge));
  }
  for (const CellEdge& edge : cell.edges) cell.lines.push_back({edge, 1});
  for (const NodeId corner : cell.corners) cell.rest_shape.push_back(tissue.rest_positions[corner.index()]);
  return true;
}

}  // namespace plica
