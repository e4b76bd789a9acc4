#include "tissue/mesh_quality.hpp"

#include <algorithm>

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
  std::vector<double> volumes, areas(tissue.cells.size(), 0.0), along, across, heights;
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
  std::vector<bool> has_area(tissue.cells.size(), false);
  for (const Facet& facet : tissue.apical_facets) {
    std::array<Vec3, 4> points;
    for (int i = 0; i < 4; ++i) points[i] = positions[facet.nodes[i].index()];
    areas[facet.cell.index()] += facet_area(points);
    has_area[facet.cell.index()] = true;
  }
  std::vector<double> apical;
  for (std::size_t c = 0; c < areas.size(); ++c)
    if (has_area[c]) apical.push_back(areas[c]);

  MeshQuality quality{spread(volumes), spread(apical), spread(along), spread(across), spread(heights), 1};
  for (const auto& element : tissue.elements)
    quality.min_scaled_jacobian =
        std::min(quality.min_scaled_jacobian, hex_scaled_jacobian(gather(positions, element)));
  return quality;
}

}  // namespace plica
