// Set "shape": how far apical faces are from round, in the terms of published vertex models.
#include <cmath>

#include "measure/measure_set.hpp"

namespace plica {
namespace {

using enum InSummary;

double length_of(const std::vector<NodeId>& chain, std::span<const Vec3> positions) {
  double length = 0;
  for (std::size_t k = 1; k < chain.size(); ++k)
    length += (positions[chain[k].index()] - positions[chain[k - 1].index()]).norm();
  return length;
}

struct ShapeIndex {
  double mean, deviation;
};

ShapeIndex shape_index(const ColumnInput& m) {
  const Tissue& tissue = m.model.tissue;
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, m.state.positions);
  double sum = 0, squares = 0;
  for (std::size_t c = 0; c < areas.size(); ++c) {
    double perimeter = 0;
    for (const CellEdge& edge : tissue.cells[c].edges)
      if (edge.side == CellSide::apical) perimeter += length_of(edge.nodes, m.state.positions);
    const double index = perimeter / std::sqrt(areas[c]);
    sum += index;
    squares += index * index;
  }
  const auto count = static_cast<double>(areas.size());
  const double mean = sum / count;
  return {mean, std::sqrt(std::max(0.0, squares / count - mean * mean))};
}

}  // namespace

MeasureSet shape_set() {
  return set_of(
      "shape", "nothing; only if named", [](const Subject&) { return kept_if(true); },
      {{"apical_shape_index", last,
        "Mean over cells of perimeter / √area of apical faces: 3.72 for regular hexagons, 4 for squares. "
        "Published vertex models are rigid below 3.81 (Bi et al. 2015, doi:10.1038/nphys3471).",
        [](const ColumnInput& m) { return m.once(shape_index).mean; }},
       {"apical_shape_index_deviation", last, "Its standard deviation over cells.",
        [](const ColumnInput& m) { return m.once(shape_index).deviation; }}},
      [](const Subject&) { return false; });
}

}  // namespace plica
