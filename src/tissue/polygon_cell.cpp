#include "tissue/polygon_cell.hpp"

#include <algorithm>
#include <limits>

namespace plica {
namespace {

// The middle of the side before a place.
OutlinePlace middle_before(const OutlineRing& ring, std::size_t i) {
  const OutlinePlace &from = ring[(i + ring.size() - 1) % ring.size()], &to = ring[i];
  return {from.wall, 0.5 * (from.at + (to.at == 0 ? 1 : to.at))};
}

// By diagonals from the place, or from the middle of the side before it when the number of places is odd.
std::vector<OutlineQuad> fan(const OutlineRing& ring, std::size_t from) {
  OutlineRing places;
  if (ring.size() % 2 == 1) places.push_back(middle_before(ring, from));
  for (std::size_t k = 0; k < ring.size(); ++k) places.push_back(ring[(from + k) % ring.size()]);
  std::vector<OutlineQuad> result;
  for (std::size_t i = 1; i + 2 < places.size(); i += 2)
    result.push_back({places[0], places[i], places[i + 1], places[i + 2]});
  return result;
}

}  // namespace

Vec3 place_in(std::span<const Vec3> polygon, const OutlinePlace& place) {
  if (place.is_middle()) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& corner : polygon) sum += corner;
    return sum / static_cast<double>(polygon.size());
  }
  const Vec3& from = polygon[place.wall];
  if (place.at == 0) return from;
  return (1 - place.at) * from + place.at * polygon[(place.wall + 1) % polygon.size()];
}

HexPoints part_over(const PrismCorners& prism, const OutlineQuad& quadrilateral) {
  HexPoints points;
  for (int i = 0; i < 8; ++i) points[i] = place_in(i < 4 ? prism.basal : prism.apical, quadrilateral[i % 4]);
  return points;
}

OutlineRing corners_of_polygon(std::size_t corners) {
  OutlineRing ring;
  for (int i = 0; i < static_cast<int>(corners); ++i) ring.push_back({i, 0});
  return ring;
}

std::vector<OutlineQuad> split_into_kites(const OutlineRing& places) {
  std::vector<OutlineQuad> result;
  for (std::size_t i = 0; i < places.size(); ++i)
    result.push_back(
        {places[i], middle_before(places, (i + 1) % places.size()), OutlinePlace{}, middle_before(places, i)});
  return result;
}

double worst_part(const PrismCorners& prism, const std::vector<OutlineQuad>& split) {
  double least = 1;
  for (const OutlineQuad& one : split) least = std::min(least, hex_scaled_jacobian(part_over(prism, one)));
  return least;
}

std::vector<OutlineQuad> best_split(const OutlineRing& places,
                                    const std::function<double(const std::vector<OutlineQuad>&)>& quality,
                                    const OutlineRing& other_places) {
  constexpr double good = 0.05, rounding = 1e-9;
  std::vector<OutlineQuad> best;
  double best_quality = -std::numeric_limits<double>::infinity();
  const auto try_it = [&](std::vector<OutlineQuad> split) {
    const double its = quality(split);
    if (its <= best_quality + rounding) return;
    best_quality = its;
    best = std::move(split);
  };
  for (const OutlineRing& ring : {places, other_places}) {
    if (ring.size() < 4 || best_quality >= good) continue;
    // Four places are one way.
    for (std::size_t i = 0; i < (ring.size() == 4 ? 1 : ring.size()); ++i) try_it(fan(ring, i));
  }
  for (const OutlineRing& ring : {places, other_places})
    if (!ring.empty() && best_quality < good) try_it(split_into_kites(ring));
  return best;
}

Vec3 outward_of(const Cell& cell, const Vectors& positions) {
  const auto corners = cell.apical_corners();
  Vec3 outward = Vec3::Zero();
  for (std::size_t i = 0; i < corners.size(); ++i)
    outward += positions[corners[i].index()].cross(positions[corners[(i + 1) % corners.size()].index()]);
  return outward.normalized();
}

double alignment_with_x(const Vec3& way, const Vec3& outward) {
  const Vec3 axis = Vec3::UnitX() - outward.x() * outward;
  if (axis.norm() < 1e-6) return 0.5;
  return std::min(1.0, way.dot(axis) * way.dot(axis) / (way.squaredNorm() * axis.squaredNorm()));
}

void set_polygon_edges(const PolygonChains& chains, const Vectors& rest_positions, Cell& cell) {
  const auto at = [&](NodeId node) -> const Vec3& { return rest_positions[node.index()]; };
  const Vec3 outward = outward_of(cell, rest_positions);
  cell.edges.clear();
  for (const CellSide side : {CellSide::basal, CellSide::apical})
    for (const auto& chain : side == CellSide::apical ? chains.apical : chains.basal) {
      CellEdge edge{chain, EdgeDirection::along, side};
      edge.along = alignment_with_x(at(chain.back()) - at(chain.front()), outward);
      if (edge.along < 0.5) edge.direction = EdgeDirection::across;
      cell.edges.push_back(std::move(edge));
    }
  for (const auto& chain : chains.lateral) cell.edges.push_back({chain, EdgeDirection::lateral, CellSide::lateral});
  cell.lines.clear();
  for (const CellEdge& edge : cell.edges) cell.lines.push_back({edge, 1});
}

std::vector<std::vector<WallStop>> walls_between_corners(const Cell& cell) {
  std::vector<std::vector<WallStop>> walls;
  const auto basal = cell.basal_corners(), apical = cell.apical_corners();
  for (std::size_t i = 0; i < cell.sides(); ++i) {
    const std::size_t next = (i + 1) % cell.sides();
    walls.push_back({{0, basal[i], apical[i]}, {1, basal[next], apical[next]}});
  }
  return walls;
}

void set_corners_and_lines_of_walls(const Vectors& rest_positions, Cell& cell) {
  PolygonChains chains;
  for (const auto& wall : cell.walls) {
    std::vector<NodeId> basal, apical;
    for (const WallStop& stop : wall) basal.push_back(stop.basal), apical.push_back(stop.apical);
    chains.lateral.push_back({basal.front(), apical.front()});
    chains.basal.push_back(std::move(basal));
    chains.apical.push_back(std::move(apical));
  }
  cell.corners.clear();
  for (const auto* sides : {&chains.basal, &chains.apical})
    for (const auto& chain : *sides) cell.corners.push_back(chain.front());
  set_polygon_edges(chains, rest_positions, cell);
}

std::vector<bool> inner_nodes_of_polygons(const Tissue& tissue) {
  std::vector<bool> is_inner(tissue.node_count(), false);
  for (const auto* facets : {&tissue.basal_facets, &tissue.apical_facets})
    for (const Facet& facet : *facets)
      for (const NodeId node : facet.nodes)
        if (node.index() < tissue.free_node_count() && !tissue.cells[facet.cell.index()].is_of_grid)
          is_inner[node.index()] = true;
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges)
      for (const NodeId node : edge.nodes) is_inner[node.index()] = false;
  return is_inner;
}

}  // namespace plica
