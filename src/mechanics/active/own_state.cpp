#include "mechanics/active/own_state.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace plica {
namespace {

/// Scalar products of the mean edges of a face, along and across.
Eigen::Matrix2d metric(const std::array<Vec3, 4>& corners) {
  Eigen::Matrix<double, 3, 2> edges;
  edges.col(0) = 0.5 * (corners[1] - corners[0] + corners[2] - corners[3]);
  edges.col(1) = 0.5 * (corners[3] - corners[0] + corners[2] - corners[1]);
  return edges.transpose() * edges;
}

}  // namespace

OwnState::OwnState(const Tissue& tissue, const OwnStateRule& rule) : rule_(rule), at_rest_(tissue.cells.size(), 0.0) {
  if (!is_used()) return;
  if (rule.measure == OwnMeasure::height_ratio) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const Cell& cell = tissue.cells[c];
      auto& edges = edges_.emplace_back();
      for (int i = 0; i < 4; ++i) {
        edges[i] = {cell.corners[i], cell.corners[i + 4]};
        at_rest_[c] += 0.25 * (cell.rest_shape[i + 4] - cell.rest_shape[i]).norm();
      }
    }
    return;
  }
  if (rule.measure == OwnMeasure::apical_stretch) {
    for (const Cell& cell : tissue.cells) {
      apices_.push_back({cell.corners[4], cell.corners[5], cell.corners[6], cell.corners[7]});
      rest_metrics_.push_back(metric({cell.rest_shape[4], cell.rest_shape[5], cell.rest_shape[6], cell.rest_shape[7]}));
    }
    std::ranges::fill(at_rest_, 1.0);
    return;
  }
  facets_ = rule.measure == OwnMeasure::apical_area_ratio ? tissue.apical_facets : tissue.basal_facets;
  for (const Facet& facet : facets_) at_rest_[facet.cell.index()] += facet_area(rest_corners(tissue, facet));
}

std::vector<double> OwnState::sizes(std::span<const Vec3> x) const {
  std::vector<double> sizes(at_rest_.size(), 0.0);
  for (const Facet& facet : facets_) sizes[facet.cell.index()] += facet_area(gather(x, facet));
  for (std::size_t c = 0; c < edges_.size(); ++c)
    for (const auto& [base, apex] : edges_[c]) sizes[c] += 0.25 * (x[apex.index()] - x[base.index()]).norm();
  // The largest root of det(now - stretch^2 rest) = 0.
  for (std::size_t c = 0; c < apices_.size(); ++c) {
    const auto& [a, b, d, e] = apices_[c];
    const Eigen::Matrix2d now = metric({x[a.index()], x[b.index()], x[d.index()], x[e.index()]});
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> squares(now, rest_metrics_[c],
                                                                            Eigen::EigenvaluesOnly);
    sizes[c] = std::sqrt(squares.eigenvalues()[1]);
  }
  return sizes;
}

std::vector<double> OwnState::ratios(std::span<const Vec3> positions) const {
  std::vector<double> ratios = sizes(positions);
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] = at_rest_[c] > 0 ? ratios[c] / at_rest_[c] : 1;
  return ratios;
}

std::vector<double> OwnState::numbers(std::span<const Vec3> positions, double time_s,
                                      std::span<const double> before) const {
  if (!is_used()) return {};
  std::vector<double> numbers = ratios(positions);
  for (std::size_t c = 0; c < numbers.size(); ++c) {
    const double ratio = numbers[c];
    if (!starts()) {
      numbers[c] = std::clamp((ratio - rule_.from) / (rule_.to - rule_.from), 0.0, 1.0);
    } else if (!before.empty() && before[c] != not_yet) {
      numbers[c] = before[c];
    } else {
      const bool has_come =
          rule_.kind == OwnStateRule::Kind::starts_below ? ratio < rule_.threshold : ratio > rule_.threshold;
      numbers[c] = has_come ? time_s : not_yet;
    }
  }
  return numbers;
}

}  // namespace plica
