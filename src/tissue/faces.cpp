#include "tissue/faces.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "tissue/mesh_faces.hpp"

namespace plica {
namespace {

// A half of what lies on a mirror plane, or at an end of a slice, is the other side's.
double share_of(const Tissue& tissue, const Face& face) {
  const double share = tissue.own_share(face.nodes);
  if (!tissue.is_endless || face.beyond || share < 1) return share;
  const auto x = [&](NodeId node) { return tissue.rest_positions[node.index()].x(); };
  const double first = x(face.nodes[0]);
  return std::ranges::all_of(face.nodes, [&](NodeId node) { return x(node) == first; }) ? 0.5 : 1;
}

std::vector<Face> lateral_faces(const Tissue& tissue) {
  auto joined = tissue.elements;
  for (auto& nodes : joined)
    for (NodeId& node : nodes) node = tissue.original(node);
  const MeshFaces pairs(joined);
  std::vector<char> is_outer(6 * tissue.elements.size(), 0);  // whether an apical or basal face of elements
  const auto place_of = [&](const Facet& facet) {
    // The face of its element that has the facet's nodes.
    const std::size_t e = facet.element.index();
    for (int f = 0; f < 6; ++f) {
      int common = 0;
      for (const int corner : hex_faces[f])
        for (const NodeId node : facet.nodes) common += tissue.elements[e][corner] == node;
      if (common == 4) return 6 * e + f;
    }
    throw std::logic_error("a facet is no face of its element");
  };
  for (const auto* facets : {&tissue.apical_facets, &tissue.basal_facets})
    for (const Facet& facet : *facets) is_outer[place_of(facet)] = 1;

  std::vector<Face> faces;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    for (int f = 0; f < 6; ++f) {
      if (is_outer[6 * e + f] != 0) continue;
      const auto other = pairs.neighbour({e, f});
      const CellId cell = tissue.element_cell[e];
      if (other && (other->cell < e || tissue.element_cell[other->cell] == cell)) continue;
      Face face{face_nodes(tissue.elements[e], f), cell, {}};
      if (other) face.beyond = tissue.element_cell[other->cell];
      face.share = share_of(tissue, face);
      faces.push_back(face);
    }
  return faces;
}

// Where lines of a cell end on a wall between its stops, elements on the two sides do not match; the stops do.
std::vector<Face> faces_between_stops(const Tissue& tissue) {
  std::vector<Face> faces;
  std::map<std::pair<NodeId, NodeId>, std::size_t> place;  // in faces, by the apical nodes
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    for (const auto& stops : tissue.cells[c].walls)
      for (std::size_t i = 1; i < stops.size(); ++i) {
        const WallStop &from = stops[i - 1], &to = stops[i];
        const auto [found, is_new] = place.emplace(std::minmax(from.apical, to.apical), faces.size());
        if (!is_new) {
          faces[found->second].beyond = CellId(c);
          continue;
        }
        faces.push_back({{from.basal, to.basal, to.apical, from.apical}, CellId(c), {}});
      }
  return faces;
}

// Where nodes hang on the edges of polygons, elements on the two sides do not match either; the lateral edges do.
std::vector<Face> faces_between_edges(const Tissue& tissue) {
  std::vector<Face> faces;
  std::map<std::pair<NodeId, NodeId>, std::size_t> place;  // in faces, by two opposite nodes
  const auto key = [&](NodeId low, NodeId high) { return std::pair(tissue.original(low), tissue.original(high)); };
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Cell& cell = tissue.cells[c];
    const std::size_t sides = cell.sides();
    const std::span<const CellEdge> lateral = std::span(cell.edges).last(sides);
    for (std::size_t i = 0; i < sides; ++i) {
      const auto &from = lateral[i].nodes, &to = lateral[(i + 1) % sides].nodes;
      for (std::size_t level = 1; level < from.size(); ++level) {
        // The neighbour has the same face from the other side.
        const auto beyond = place.find(key(to[level - 1], from[level]));
        if (beyond != place.end()) {
          faces[beyond->second].beyond = CellId(c);
          continue;
        }
        place.emplace(key(from[level - 1], to[level]), faces.size());
        faces.push_back({{from[level - 1], to[level - 1], to[level], from[level]}, CellId(c), {}});
      }
    }
  }
  return faces;
}

std::vector<Face> all_lateral_faces(const Tissue& tissue) {
  if (std::ranges::all_of(tissue.hanging, [](const NodeMean& mean) { return mean.size() == 1; }))
    return lateral_faces(tissue);
  std::vector<Face> faces =
      tissue.cells.front().walls.empty() ? faces_between_edges(tissue) : faces_between_stops(tissue);
  for (Face& face : faces) face.share = share_of(tissue, face);
  return faces;
}

}  // namespace

std::vector<Face> faces_of(const Tissue& tissue, CellSide side) {
  if (side == CellSide::lateral) return all_lateral_faces(tissue);
  std::vector<Face> faces;
  for (const Facet& facet : side == CellSide::apical ? tissue.apical_facets : tissue.basal_facets)
    faces.push_back({facet.nodes, facet.cell, {}});
  return faces;
}

std::vector<std::pair<NodeId, NodeId>> rim_of(const Tissue& tissue, std::span<const Facet> facets) {
  // How often each pair of free nodes is an edge, the other way round counted as less. Edges are straight and hanging
  // nodes means of free ones, so that an edge is a sum over pairs of those, and those on one line cancel.
  std::map<std::pair<NodeId, NodeId>, double> uses;
  for (const Facet& facet : facets)
    for (int i = 0; i < 4; ++i)
      tissue.for_free_nodes(facet.nodes[i], [&](NodeId from, double weight) {
        tissue.for_free_nodes(facet.nodes[(i + 1) % 4], [&](NodeId to, double weight_of_to) {
          if (from != to) uses[std::minmax(from, to)] += (from < to ? 1 : -1) * weight * weight_of_to;
        });
      });
  std::vector<std::pair<NodeId, NodeId>> rim;
  for (const auto& [edge, use] : uses) {
    constexpr double rounding = 1e-9;
    if (use > rounding) rim.push_back(edge);
    if (use < -rounding) rim.emplace_back(edge.second, edge.first);
  }
  return rim;
}

bool encloses(const Tissue& tissue, std::span<const Facet> facets) {
  return !tissue.is_periodic() && rim_of(tissue, facets).empty();
}

bool goes_round(const Tissue& tissue) { return tissue.is_endless || encloses(tissue, tissue.apical_facets); }

std::vector<std::vector<CellId>> wall_neighbours(const Tissue& tissue) {
  std::vector<std::vector<CellId>> neighbours(tissue.cells.size());
  for (const Face& face : all_lateral_faces(tissue))
    if (face.beyond) {
      neighbours[face.cell.index()].push_back(*face.beyond);
      neighbours[face.beyond->index()].push_back(face.cell);
    }
  for (std::vector<CellId>& of_cell : neighbours) {
    std::ranges::sort(of_cell);
    of_cell.erase(std::unique(of_cell.begin(), of_cell.end()), of_cell.end());
  }
  return neighbours;
}

std::optional<CellId> cell_between_layers(const Tissue& tissue) {
  CellSet apical(tissue.cells.size(), false), basal = apical;
  for (const Facet& facet : tissue.apical_facets) apical[facet.cell.index()] = true;
  for (const Facet& facet : tissue.basal_facets) basal[facet.cell.index()] = true;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    if (!apical[c] || !basal[c]) return CellId(c);
  return std::nullopt;
}

}  // namespace plica
