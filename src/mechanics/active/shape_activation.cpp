#include "mechanics/active/shape_activation.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mechanics/law.hpp"
#include "tissue/faces.hpp"

namespace plica {

std::vector<Eigen::RowVector2d> mean_gradient(std::span<const Vec3> polygon) {
  const std::size_t n = polygon.size();
  Vec3 twice_area = Vec3::Zero();
  for (std::size_t i = 0; i < n; ++i) twice_area += (polygon[i] - polygon[0]).cross(polygon[(i + 1) % n] - polygon[0]);
  const Vec3 normal = twice_area.normalized(), u = normal.unitOrthogonal(), v = normal.cross(u);
  std::vector<Eigen::RowVector2d> weights;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 across = polygon[(i + 1) % n] - polygon[(i + n - 1) % n];
    weights.emplace_back(Eigen::RowVector2d(across.dot(v), -across.dot(u)) / twice_area.norm());
  }
  return weights;
}

ShapeActivation::ShapeActivation(const Tissue& tissue, const ShapeActivationRule& rule)
    : rule_(rule), at_rest_(tissue.cells.size(), 0.0) {
  if (is_used() && rule.of_neighbours) neighbours_ = neighbours_and_images(tissue);
  if (!is_used() || rule.signal) return;
  if (rule.measure == ShapeMeasure::height_ratio) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const Cell& cell = tissue.cells[c];
      auto& edges = edges_.emplace_back();
      const std::size_t sides = cell.sides();
      for (std::size_t i = 0; i < sides; ++i) {
        edges.push_back({cell.corners[i], cell.corners[i + sides]});
        at_rest_[c] += (cell.rest_shape[i + sides] - cell.rest_shape[i]).norm() / static_cast<double>(sides);
      }
    }
    return;
  }
  if (rule.measure == ShapeMeasure::apical_stretch) {
    for (const Cell& cell : tissue.cells) {
      apices_.emplace_back(cell.apical_corners().begin(), cell.apical_corners().end());
      gradients_.push_back(mean_gradient(std::span(cell.rest_shape).last(cell.sides())));
    }
    std::ranges::fill(at_rest_, 1.0);
    return;
  }
  const CellSide side = rule.measure == ShapeMeasure::apical_area_ratio ? CellSide::apical : CellSide::basal;
  facets_ = tissue.facets(side);
  at_rest_ = rest_face_areas(tissue, side);
}

std::vector<double> ShapeActivation::sizes(std::span<const Vec3> x) const {
  std::vector<double> sizes(at_rest_.size(), 0.0);
  for (const Facet& facet : facets_) sizes[facet.cell.index()] += facet_area(gather(x, facet));
  for (std::size_t c = 0; c < edges_.size(); ++c)
    for (const auto& [base, apex] : edges_[c])
      sizes[c] += (x[apex.index()] - x[base.index()]).norm() / static_cast<double>(edges_[c].size());
  for (std::size_t c = 0; c < apices_.size(); ++c) {
    const Eigen::Matrix<double, 3, 2> stretch = apical_stretch(c, x);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> squares(stretch.transpose() * stretch, Eigen::EigenvaluesOnly);
    sizes[c] = std::sqrt(squares.eigenvalues()[1]);
  }
  return sizes;
}

Eigen::Matrix<double, 3, 2> ShapeActivation::apical_stretch(std::size_t c, std::span<const Vec3> x) const {
  Eigen::Matrix<double, 3, 2> stretch = Eigen::Matrix<double, 3, 2>::Zero();
  for (std::size_t i = 0; i < apices_[c].size(); ++i) stretch += x[apices_[c][i].index()] * gradients_[c][i];
  return stretch;
}

std::vector<double> ShapeActivation::ratios(std::span<const Vec3> positions) const {
  std::vector<double> ratios = sizes(positions);
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = at_rest_[c] > 0 ? ratios[c] / at_rest_[c] : 1;
  return ratios;
}

std::vector<double> ShapeActivation::read(std::vector<double> values) const {
  if (neighbours_.empty()) return values;
  std::vector<double> means(values.size(), 0.0);
  for (std::size_t c = 0; c < means.size(); ++c)
    for (const CellId from : neighbours_[c])
      means[c] += values[from.index()] / static_cast<double>(neighbours_[c].size());
  return means;
}

std::vector<double> ShapeActivation::internal(std::span<const Vec3> positions, double time_s,
                                              std::span<const double> before) const {
  if (!is_used()) return {};
  if (!rule_.signal) return next(read(ratios(positions)), time_s, before);
  if (before.empty()) return std::vector<double>(at_rest_.size(), starts() ? not_yet : 0);
  return {before.begin(), before.end()};
}

std::vector<double> ShapeActivation::after(const Step& step, std::span<const double> before) const {
  std::vector<double> state = internal(step.positions, step.end_time_s, before);
  return rule_.at_crossing ? after_like(step, before, state) : state;
}

std::vector<double> ShapeActivation::of_signals(std::span<const CellArray> signals, double time_s,
                                                std::span<const double> before) const {
  if (!rule_.signal) return {before.begin(), before.end()};
  return next(read(signals[*rule_.signal]), time_s, before);
}

std::vector<double> ShapeActivation::next(std::vector<double> values, double time_s,
                                          std::span<const double> before) const {
  for (std::size_t c = 0; c < values.size(); ++c) {
    const double ratio = values[c];
    if (!starts()) {
      values[c] = std::clamp(progress(ratio), 0.0, 1.0);
    } else if (!before.empty() && before[c] != not_yet) {
      values[c] = before[c];
    } else {
      const bool has_come =
          rule_.kind == ShapeActivationRule::Kind::starts_below ? ratio < rule_.threshold : ratio > rule_.threshold;
      values[c] = has_come ? time_s : not_yet;
    }
  }
  return values;
}

}  // namespace plica
