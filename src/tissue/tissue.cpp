#include "tissue/tissue.hpp"

#include <algorithm>

namespace plica {

double Tissue::side_share(std::span<const NodeId> nodes) const {
  double share = 1;
  for (int axis = 0; axis < 3; ++axis)
    if (is_mirrored[axis] &&
        std::ranges::all_of(nodes, [&](NodeId node) { return rest_positions[node.index()][axis] == 0; }))
      share /= 2;
  return share;
}

void Tissue::place_hanging(std::span<Vec3> vectors) const {
  for (std::size_t h = 0; h < hanging.size(); ++h) vectors[free_node_count() + h] = mean_of(hanging[h], vectors);
}

void Tissue::place_hanging_positions(std::span<Vec3> positions) const {
  place_hanging(positions);
  for (std::size_t h = 0; h < hanging_shifts.size(); ++h) positions[free_node_count() + h] += hanging_shifts[h];
}

void Tissue::carry_hanging(std::span<Vec3> forces) const {
  for (std::size_t h = 0; h < hanging.size(); ++h) {
    Vec3& force = forces[free_node_count() + h];
    for (const auto& [node, weight] : hanging[h]) forces[node.index()] += weight * force;
    force.setZero();
  }
}

HexPoints hexahedron(std::span<const Vec3> corners) {
  HexPoints points;
  std::ranges::copy(corners.first(points.size()), points.begin());
  return points;
}

Vec3 cell_centre(const Cell& cell, const Vectors& positions) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : cell.corners) sum += positions[node.index()];
  return sum / static_cast<double>(cell.corners.size());
}

double cell_volume(const Tissue& tissue, const Cell& cell, std::span<const Vec3> positions) {
  double volume = 0;
  for (int e = 0; e < cell.element_count; ++e)
    volume += hex_volume(gather(positions, tissue.elements[cell.first_element.index() + e]));
  return volume;
}

double rest_volume(const Tissue& tissue, const Cell& cell) {
  double volume = 0;
  for (int e = 0; e < cell.element_count; ++e)
    volume += hex_volume(tissue.element_rest_shape[cell.first_element.index() + e]);
  return volume;
}

std::array<Vec3, 4> rest_corners(const Tissue& tissue, const Facet& facet) {
  const auto& nodes = tissue.elements[facet.element.index()];
  const HexPoints& rest = tissue.element_rest_shape[facet.element.index()];
  std::array<Vec3, 4> points;
  for (int i = 0; i < 4; ++i) points[i] = rest[std::ranges::find(nodes, facet.nodes[i]) - nodes.begin()];
  return points;
}

Extent extent_along(const Tissue& tissue) {
  Extent extent;
  for (const Vec3& x : tissue.rest_positions) extent.take(x.x());
  return extent;
}

std::vector<double> face_areas(const Tissue& tissue, CellSide side, std::span<const Vec3> positions) {
  std::vector<double> areas(tissue.cells.size(), 0.0);
  for (const Facet& facet : tissue.facets(side)) areas[facet.cell.index()] += facet_area(gather(positions, facet));
  return areas;
}

std::vector<double> rest_face_areas(const Tissue& tissue, CellSide side) {
  std::vector<double> areas(tissue.cells.size(), 0.0);
  for (const Facet& facet : tissue.facets(side)) areas[facet.cell.index()] += facet_area(rest_corners(tissue, facet));
  return areas;
}

}  // namespace plica
