// Derivatives of a step of signals for gradients of runs: its parts backwards. A part solves M c' = a with the amounts
// a = V (c + p (s + r)); with the gradient g' by c', y = M^-1 g' is that by a, and -y c'^T that by M.
#include <stdexcept>

#include "mechanics/active/shape_activation.hpp"
#include "mechanics/signals/signal_parts.hpp"

namespace plica {

Signals::Values Signals::pull_back(const Tissue& tissue, const Geometry& geometry, double duration_s,
                                   const Values& before, Values gradient, GeometryGradient& by_geometry) const {
  const auto& [volumes_before, volumes, positions] = geometry;
  const std::size_t cells = volumes.size(), signals = size();
  Parts parts;
  if (const auto failure = take_parts(tissue, geometry, duration_s, before, parts))
    throw std::runtime_error("gradient: " + failure->problem);

  Chemistry chemistry(rules_, tissue, positions);
  Values rates(signals, CellArray(cells, 0.0));
  std::vector<double> by_conductance(faces_.size(), 0.0);
  std::vector<std::vector<double>> by_measure(shape_measure_names.size(), std::vector<double>(cells, 0.0));
  for (std::size_t part = parts.values.size() - 1; part-- > 0;) {
    const Values &from = parts.values[part], &to = parts.values[part + 1];
    if (chemistry.any()) (void)chemistry.take_rates(rules_, from, rates);
    Values by_amounts;
    for (std::size_t s = 0; s < signals; ++s) {
      const Diffusion& diffusion = *parts.diffusions[s];
      const CellArray& y = by_amounts.emplace_back(diffusion.solution(gradient[s], volumes));
      for (std::size_t i = 0; i < cells; ++i)
        by_geometry.volumes[i] +=
            y[i] * (from[s][i] + diffusion.rate_s * (rules_[s].sources[i] + rates[s][i]) - diffusion.growth * to[s][i]);
      for (std::size_t f = 0; diffusion.diffuses && f < faces_.size(); ++f) {
        const std::size_t a = faces_[f].cell.index(), b = faces_[f].beyond->index();
        by_conductance[f] -= diffusion.rate_s * rules_[s].diffusion * (y[a] - y[b]) * (to[s][a] - to[s][b]);
      }
      for (std::size_t i = 0; i < cells; ++i) gradient[s][i] = volumes[i] * y[i];
    }
    if (!chemistry.any()) continue;
    std::vector<double> changes = Chemistry::small_changes(from, 1e-5);
    changes.resize(signals + by_measure.size(), 1e-5);
    for (std::size_t i = 0; i < cells; ++i) {
      chemistry.go_to(i, from);
      for (std::size_t s = 0; s < signals; ++s) {
        if (!chemistry.reactions[s]) continue;
        const double by_rate = parts.diffusions[s]->rate_s * volumes[i] * by_amounts[s][i];
        for (std::size_t v = 0; v < changes.size(); ++v)
          (v < signals ? gradient[v][i] : by_measure[v - signals][i]) += by_rate * chemistry.slope(s, v, changes[v]);
      }
    }
  }
  for (std::size_t s = 0; s < signals; ++s)
    for (std::size_t i = 0; i < cells; ++i) {
      by_geometry.volumes_before[i] += gradient[s][i] * before[s][i] / volumes[i];
      by_geometry.volumes[i] -= gradient[s][i] * before[s][i] * volumes_before[i] / (volumes[i] * volumes[i]);
      gradient[s][i] *= volumes_before[i] / volumes[i];
    }
  add_conductance_gradient(tissue, positions, by_conductance, by_geometry.positions);
  for (std::size_t m = 0; m < by_measure.size(); ++m)
    if (!chemistry.measures[m].empty())
      ShapeActivation(tissue, measured(m)).add_ratio_gradient(positions, by_measure[m], by_geometry.positions);
  return gradient;
}

void Signals::add_conductance_gradient(const Tissue& tissue, const Vectors& positions, std::span<const double> of_faces,
                                       std::span<Vec3> gradient) const {
  Vectors by_centre(tissue.cells.size(), Vec3::Zero());
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const std::size_t a = faces_[f].cell.index(), b = faces_[f].beyond->index();
    const Vec3 apart =
        between_centres(tissue, cell_centre(tissue.cells[a], positions), cell_centre(tissue.cells[b], positions));
    const std::array<Vec3, 4> corners = gather(positions, faces_[f].nodes);
    const double of_area = of_faces[f] * faces_[f].share / apart.norm();
    const std::array<Vec3, 4> by_corner = facet_area_gradient(corners);
    for (int i = 0; i < 4; ++i) gradient[faces_[f].nodes[i].index()] += of_area * by_corner[i];
    const Vec3 by_distance = of_area * facet_area(corners) / apart.squaredNorm() * apart;
    by_centre[a] += by_distance;
    by_centre[b] -= by_distance;
  }
  for (std::size_t c = 0; c < by_centre.size(); ++c) {
    const Cell& cell = tissue.cells[c];
    for (const NodeId node : cell.corners)
      gradient[node.index()] += by_centre[c] / static_cast<double>(cell.corners.size());
  }
}

}  // namespace plica
