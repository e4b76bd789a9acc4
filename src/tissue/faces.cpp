#include "tissue/faces.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "tissue/mesh_faces.hpp"

namespace plica {
namespace {

// Half of a face on a mirror plane, or at an end of a slice, belongs to the other side.
double share_of(const Tissue& tissue, const Face& face) {
  const double share = tissue.side_share(face.nodes);
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

using Panel = std::array<NodeId, 4>;

// The parts of the lateral faces of a polygonal cell that its neighbours have, too: between the stops of a wall, or
// between the levels of the lateral edges. Elements on the two sides do not match there: lines of a cell end on a wall
// between its stops, and nodes hang on edges.
std::vector<Panel> panels_of(const Cell& cell) {
  std::vector<Panel> panels;
  for (const auto& stops : cell.walls)
    for (std::size_t i = 1; i < stops.size(); ++i)
      panels.push_back({stops[i - 1].basal, stops[i].basal, stops[i].apical, stops[i - 1].apical});
  if (!cell.walls.empty()) return panels;
  const std::span<const CellEdge> lateral = std::span(cell.edges).last(cell.sides());
  for (std::size_t i = 0; i < cell.sides(); ++i) {
    const auto &from = lateral[i].nodes, &to = lateral[(i + 1) % cell.sides()].nodes;
    for (std::size_t level = 1; level < from.size(); ++level)
      panels.push_back({from[level - 1], to[level - 1], to[level], from[level]});
  }
  return panels;
}

std::vector<Face> faces_of_panels(const Tissue& tissue) {
  std::vector<Face> faces;
  std::map<std::pair<NodeId, NodeId>, std::size_t> place;  // in faces, by two opposite nodes
  const auto key = [&](NodeId low, NodeId high) { return std::pair(tissue.original(low), tissue.original(high)); };
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    for (const Panel& panel : panels_of(tissue.cells[c])) {
      // The neighbour has the same face from the other side.
      if (const auto beyond = place.find(key(panel[1], panel[3])); beyond != place.end()) {
        faces[beyond->second].beyond = CellId(c);
        continue;
      }
      place.emplace(key(panel[0], panel[2]), faces.size());
      faces.push_back({panel, CellId(c), {}});
    }
  return faces;
}

std::vector<Face> all_lateral_faces(const Tissue& tissue) {
  if (std::ranges::all_of(tissue.hanging, [](const NodeMean& mean) { return mean.size() == 1; }))
    return lateral_faces(tissue);
  std::vector<Face> faces = faces_of_panels(tissue);
  for (Face& face : faces) face.share = share_of(tissue, face);
  return faces;
}

constexpr double nothing_um = 1e-6;  // rounding

// Cell rows between a cell and the midline: 0 if the midline cuts the cell, 1 if it is a side of it; else -1.
int start_at_midline(const Tissue& tissue, const Cell& cell, bool has_back) {
  Extent across;
  double height = 0;
  int on_it = 0;
  for (const NodeId corner : cell.apical_corners()) {
    const Vec3& x = tissue.rest_positions[corner.index()];
    across.take(x.y());
    height += x.z();
    on_it += static_cast<int>(std::abs(x.y()) < nothing_um);
  }
  if (has_back && height >= 0) return -1;
  if (across.low < -nothing_um && across.high > nothing_um) return 0;
  return on_it > 1 ? 1 : -1;
}

// Propagate given numbers, adding `step` through every lateral face, up to `most`.
void spread(const Tissue& tissue, int step, int most, std::vector<int>& numbers) {
  const std::vector<std::vector<CellId>> neighbours = wall_neighbours(tissue);
  std::vector<std::size_t> front;
  for (std::size_t c = 0; c < numbers.size(); ++c)
    if (numbers[c] >= 0) front.push_back(c);
  std::ranges::stable_sort(front, {}, [&](std::size_t c) { return numbers[c]; });
  for (std::size_t i = 0; i < front.size(); ++i) {
    const int next = numbers[front[i]] + step;
    if (next > most) continue;
    for (const CellId cell : neighbours[front[i]]) {
      int& number = numbers[cell.index()];
      if (number >= 0 && number <= next) continue;
      number = next;
      front.push_back(cell.index());
    }
  }
}

}  // namespace

std::vector<Face> faces_of(const Tissue& tissue, CellSide side) {
  if (side == CellSide::lateral) return all_lateral_faces(tissue);
  std::vector<Face> faces;
  for (const Facet& facet : tissue.facets(side)) faces.push_back({facet.nodes, facet.cell, {}});
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

std::vector<int> half_cells_from_midline(const Tissue& tissue) {
  std::vector<int> numbers;
  const bool has_back = goes_round(tissue);
  for (const Cell& cell : tissue.cells) numbers.push_back(start_at_midline(tissue, cell, has_back));
  spread(tissue, 2, std::numeric_limits<int>::max() - 2, numbers);
  return numbers;
}

CellSet cells_around(const Tissue& tissue, const CellSet& cells, int rings) {
  std::vector<int> numbers;
  for (const bool is_in : cells) numbers.push_back(is_in ? 0 : -1);
  spread(tissue, 1, rings, numbers);
  CellSet around(cells.size());
  for (std::size_t c = 0; c < cells.size(); ++c) around[c] = numbers[c] > 0;
  return around;
}

}  // namespace plica
