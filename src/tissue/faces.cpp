#include "tissue/faces.hpp"

#include <algorithm>
#include <limits>
#include <map>

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

struct Panel {
  std::array<NodeId, 4> nodes;
  WallId wall;
};

// Lateral faces of a cell, wall by wall and from base to apex. Elements on the two sides of a wall need not match:
// lines of a cell end on it between its stops, and nodes hang on edges.
std::vector<Panel> panels_of(const Sheet& sheet, const Polygon& polygon) {
  std::vector<Panel> panels;
  for (std::size_t i = 0; i < polygon.ring.size(); ++i) {
    const auto& from = sheet.vertices[polygon.ring[i].vertex.index()].nodes;
    const auto& to = sheet.vertices[polygon.after(i).vertex.index()].nodes;
    for (std::size_t level = 1; level < from.size(); ++level)
      panels.push_back({{from[level - 1], to[level - 1], to[level], from[level]}, polygon.ring[i].wall});
  }
  return panels;
}

// Where no node hangs between others, they are faces of elements, and come in their order.
std::vector<Panel> in_order_of_elements(const Tissue& tissue, const Cell& cell, const std::vector<Panel>& panels) {
  const auto sorted = [](std::array<NodeId, 4> nodes) {
    std::ranges::sort(nodes);
    return nodes;
  };
  std::map<std::array<NodeId, 4>, Panel> by_nodes;
  for (const Panel& panel : panels) by_nodes[sorted(panel.nodes)] = panel;
  std::vector<Panel> in_order;
  const std::size_t begin = cell.first_element.index();
  for (std::size_t e = begin; e < begin + cell.element_count; ++e)
    for (int f = 0; f < 4; ++f)
      if (const auto found = by_nodes.find(sorted(face_nodes(tissue.elements[e], f))); found != by_nodes.end())
        in_order.push_back(found->second);
  return in_order;
}

// Each for the first of its cells.
std::vector<Face> lateral_faces(const Tissue& tissue) {
  const bool conforms = std::ranges::all_of(tissue.hanging, [](const NodeMean& mean) { return mean.size() == 1; });
  std::vector<Face> faces;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    std::vector<Panel> panels = panels_of(tissue.sheet, tissue.sheet.cells[c]);
    if (conforms) panels = in_order_of_elements(tissue, tissue.cells[c], panels);
    for (const Panel& panel : panels) {
      const CellId beyond = tissue.sheet.walls[panel.wall.index()].beyond(CellId(c));
      if (beyond.valid() && beyond < CellId(c)) continue;
      Face face{panel.nodes, CellId(c), beyond.valid() ? std::optional(beyond) : std::nullopt};
      face.share = share_of(tissue, face);
      faces.push_back(face);
    }
  }
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
  if (side == CellSide::lateral) return lateral_faces(tissue);
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
  for (const auto& [cells] : tissue.sheet.walls)
    if (cells[0].valid() && cells[1].valid())
      for (const std::size_t i : {0, 1}) neighbours[cells[i].index()].push_back(cells[1 - i]);
  for (std::vector<CellId>& of_cell : neighbours) {
    std::ranges::sort(of_cell);
    of_cell.erase(std::unique(of_cell.begin(), of_cell.end()), of_cell.end());
  }
  return neighbours;
}

double wall_share(const Tissue& tissue, CellId cell, std::size_t stop) {
  const Polygon& polygon = tissue.sheet.cells[cell.index()];
  const auto& from = tissue.sheet.vertices[polygon.ring[stop].vertex.index()].nodes;
  const auto& to = tissue.sheet.vertices[polygon.after(stop).vertex.index()].nodes;
  const CellId beyond = tissue.sheet.walls[polygon.ring[stop].wall.index()].beyond(cell);
  return share_of(tissue, {{from.front(), to.front(), to.back(), from.back()},
                           cell,
                           beyond.valid() ? std::optional(beyond) : std::nullopt});
}

std::vector<std::vector<CellId>> neighbours_and_images(const Tissue& tissue) {
  std::vector<std::vector<CellId>> neighbours = wall_neighbours(tissue);
  for (std::size_t c = 0; c < neighbours.size(); ++c) {
    for (std::size_t i = 0; i < tissue.sheet.cells[c].ring.size(); ++i)
      if (tissue.sheet.cells[c].ring[i].at == 0 && wall_share(tissue, CellId(c), i) < 1)
        neighbours[c].push_back(CellId(c));
    if (neighbours[c].empty()) neighbours[c] = {CellId(c)};
  }
  return neighbours;
}

std::optional<CellId> cell_between_layers(const Tissue& tissue) {
  for (std::size_t c = 0; c < tissue.cells.size(); ++c)
    if (!tissue.sheet.cells[c].has_apical || !tissue.sheet.cells[c].has_basal) return CellId(c);
  return std::nullopt;
}

double height_percent(const Tissue& tissue, CellId cell, std::span<const NodeId> nodes) {
  const auto mean = [&](std::span<const NodeId> of) {
    Vec3 sum = Vec3::Zero();
    for (const NodeId node : of) sum += tissue.rest_positions[node.index()];
    return Vec3(sum / static_cast<double>(of.size()));
  };
  const Vec3 base = mean(tissue.cells[cell.index()].basal_corners());
  const Vec3 up = mean(tissue.cells[cell.index()].apical_corners()) - base;
  return 100 * (mean(nodes) - base).dot(up) / up.squaredNorm();
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
