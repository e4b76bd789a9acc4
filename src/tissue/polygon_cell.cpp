#include "tissue/polygon_cell.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "tissue/faces.hpp"

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

using NextNodes = std::map<NodeId, NodeId>;  // from a node to the next

// About the facets, counter-clockwise seen from above the apex.
NextNodes rim_of(std::span<const Facet> facets, CellSide side) {
  std::map<std::pair<NodeId, NodeId>, int> edges;
  for (const Facet& facet : facets)
    for (int i = 0; i < 4; ++i) {
      NodeId from = facet.nodes[i], to = facet.nodes[(i + 1) % 4];
      if (side == CellSide::basal) std::swap(from, to);
      ++edges[{from, to}];
    }
  NextNodes rim;
  for (const auto& [edge, count] : edges)
    if (!edges.contains({edge.second, edge.first})) rim[edge.first] = edge.second;
  return rim;
}

// The free nodes from one to another; empty where the steps do not lead there.
std::vector<NodeId> chain(const Tissue& tissue, const NextNodes& steps, NodeId from, NodeId to) {
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

using Lines = std::vector<ContractileLine>;

Lines lines_of_face(const Cell& cell, CellSide side) {
  Lines lines;
  for (const auto& [chain, share] : cell.lines)
    if (chain.side == side) lines.push_back({chain.nodes, chain.direction, chain.along, share});
  return lines;
}

// From the base to the apex above each node of the basal edges, corners first.
Lines lines_of_walls(const Tissue& tissue, const Cell& cell) {
  const std::map<NodeId, NodeId> above = nodes_above(tissue, cell);
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

std::vector<bool> inner_nodes_of_polygons(const Tissue& tissue) {
  std::vector<bool> is_inner(tissue.node_count(), false);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    if (!tissue.cells[c].is_of_grid)
      for (const VertexId vertex : tissue.sheet.cells[c].inner) {
        const std::vector<NodeId>& nodes = tissue.sheet.vertices[vertex.index()].nodes;
        for (const NodeId node : {nodes.front(), nodes.back()}) is_inner[node.index()] = true;
      }
  return is_inner;
}

std::map<NodeId, NodeId> nodes_above(const Tissue& tissue, const Cell& cell) {
  std::map<NodeId, NodeId> above;
  for (int e = 0; e < cell.element_count; ++e) {
    const auto& nodes = tissue.elements[cell.first_element.index() + static_cast<std::size_t>(e)];
    for (int i = 0; i < 4; ++i) above[nodes[i]] = nodes[i + 4];
  }
  return above;
}

std::optional<PolygonChains> chains_about(const Tissue& tissue, std::span<const Facet> basal,
                                          std::span<const Facet> apical, const Cell& cell) {
  PolygonChains chains;
  const std::size_t n = cell.sides();
  for (const CellSide side : {CellSide::basal, CellSide::apical}) {
    const auto corners = side == CellSide::apical ? cell.apical_corners() : cell.basal_corners();
    const NextNodes rim = rim_of(side == CellSide::apical ? apical : basal, side);
    for (std::size_t i = 0; i < n; ++i)
      (side == CellSide::apical ? chains.apical : chains.basal)
          .push_back(chain(tissue, rim, corners[i], corners[(i + 1) % n]));
  }
  const NextNodes above = nodes_above(tissue, cell);
  for (std::size_t i = 0; i < n; ++i)
    chains.lateral.push_back(chain(tissue, above, cell.basal_corners()[i], cell.apical_corners()[i]));
  for (const auto* some : {&chains.basal, &chains.apical, &chains.lateral})
    for (const auto& one : *some)
      if (one.empty()) return std::nullopt;
  return chains;
}

std::vector<std::vector<ContractileLine>> contractile_lines(const Tissue& tissue, CellSide side) {
  std::vector<Lines> lines;
  if (side == CellSide::lateral) {
    for (const Cell& cell : tissue.cells) lines.push_back(lines_of_walls(tissue, cell));
    return lines;
  }
  for (const Cell& cell : tissue.cells) lines.push_back(lines_of_face(cell, side));
  const std::vector<bool> is_inner = inner_nodes_of_polygons(tissue);
  const std::span<const Facet> facets = tissue.facets(side);
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

std::vector<std::vector<ContractileLine>> border_lines(const Tissue& tissue, CellSide side, const CellSet& inside,
                                                       const OtherSide& other) {
  const auto way = [&](const ContractileLine& line) {
    return Vec3(tissue.rest_positions[line.nodes[1].index()] - tissue.rest_positions[line.nodes[0].index()]);
  };
  std::vector<Lines> lines(tissue.cells.size());
  for (std::size_t c = 0; c < inside.size(); ++c) {
    if (!inside[c]) continue;
    const Polygon& polygon = tissue.sheet.cells[c];
    const Vec3 outward = outward_of(tissue.cells[c], tissue.rest_positions);
    const auto is_border = [&](std::size_t stop) {
      const CellId beyond = tissue.sheet.walls[polygon.ring[stop].wall.index()].beyond(CellId(c));
      if (beyond.valid()) return !inside[beyond.index()] && other.cells[beyond.index()];
      return other.has_rim && wall_share(tissue, CellId(c), stop) == 1;
    };
    const auto node_of = [&](const Stop& stop) {
      const std::vector<NodeId>& nodes = tissue.sheet.vertices[stop.vertex.index()].nodes;
      return side == CellSide::apical ? nodes.back() : nodes.front();
    };
    for (std::size_t stop = 0; stop < polygon.ring.size(); ++stop) {
      if (!is_border(stop)) continue;
      ContractileLine line;
      line.nodes = {node_of(polygon.ring[stop]), node_of(polygon.after(stop))};
      line.along = alignment_with_x(way(line), outward);
      line.direction = line.along < 0.5 ? EdgeDirection::across : EdgeDirection::along;
      line.in_series = 1 / (polygon.end_of(stop) - polygon.ring[stop].at);
      lines[c].push_back(std::move(line));
    }
  }
  return lines;
}

}  // namespace plica
