#include "tissue/mesh_quality.hpp"

#include <algorithm>
#include <limits>

#include "tissue/faces.hpp"

namespace plica {
namespace {

Spread spread(const std::vector<double>& values) {
  Spread result;
  if (values.empty()) return result;
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  double sum = 0;
  for (const double value : values) sum += value;
  return {*low, sum / static_cast<double>(values.size()), *high};
}

}  // namespace

MeshQuality mesh_quality(const Tissue& tissue, const Vectors& positions) {
  std::vector<double> volumes, along, across, heights;
  for (const Cell& cell : tissue.cells) {
    volumes.push_back(cell_volume(tissue, cell, positions));
    for (const CellEdge& edge : cell.edges) {
      double length = 0;
      for (std::size_t s = 1; s < edge.nodes.size(); ++s)
        length += (positions[edge.nodes[s].index()] - positions[edge.nodes[s - 1].index()]).norm();
      auto& lengths = edge.direction == EdgeDirection::along    ? along
                      : edge.direction == EdgeDirection::across ? across
                                                                : heights;
      lengths.push_back(length);
    }
  }
  std::vector<double> areas = face_areas(tissue, CellSide::apical, positions);
  std::erase(areas, 0.0);  // of cells without an apical face
  MeshQuality quality{spread(volumes), spread(areas), spread(along), spread(across), spread(heights), 1, CellId(0)};
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    const double jacobian = hex_scaled_jacobian(gather(positions, tissue.elements[e]));
    if (jacobian >= quality.min_scaled_jacobian) continue;
    quality.min_scaled_jacobian = jacobian;
    quality.worst_cell = tissue.element_cell[e];
  }
  return quality;
}

PolygonQuality polygon_quality(const Tissue& tissue, const Vectors& positions) {
  PolygonQuality quality;
  const auto count = [](std::vector<std::size_t>& counts, std::size_t number) {
    if (counts.size() <= number) counts.resize(number + 1, 0);
    ++counts[number];
  };
  std::vector<double> edges;
  for (const Cell& cell : tissue.cells) {
    count(quality.corner_counts, cell.sides());
    for (const CellEdge& edge : cell.edges)
      if (edge.side == CellSide::apical)
        edges.push_back((positions[edge.nodes.back().index()] - positions[edge.nodes.front().index()]).norm());
  }
  CellSet at_rim(tissue.cells.size(), false);
  for (const Face& face : faces_of(tissue, CellSide::lateral))
    if (!face.beyond) at_rim[face.cell.index()] = true;
  for (const auto& neighbours : wall_neighbours(tissue)) count(quality.neighbours, neighbours.size());
  quality.rim_cells = static_cast<std::size_t>(std::ranges::count(at_rim, true));
  quality.apical_edge_um = spread(edges);
  quality.basal_area_um2 = spread(face_areas(tissue, CellSide::basal, positions));
  return quality;
}

double min_scaled_jacobian(const Tissue& tissue, const Vectors& positions) {
  double least = 1;
  for (const auto& element : tissue.elements) least = std::min(least, hex_scaled_jacobian(gather(positions, element)));
  return least;
}

CornerRatio least_corner_ratio(const Tissue& tissue, const Vectors& positions) {
  CornerRatio least{std::numeric_limits<double>::infinity(), CellId(0)};
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    const auto now = hex_corner_jacobians(gather(positions, tissue.elements[e]));
    const auto rest = hex_corner_jacobians(tissue.element_rest_shape[e]);
    for (int corner = 0; corner < 8; ++corner)
      if (const double ratio = now[corner] / rest[corner]; ratio < least.ratio) least = {ratio, tissue.element_cell[e]};
  }
  return least;
}

}  // namespace plica
