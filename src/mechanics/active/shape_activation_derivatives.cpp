// Derivatives of shape-dependent activity for gradients of runs: of start times, with m_0 and m_1 the measure at the
// beginning and at the end of the step in which it passes the threshold m,
//   t = t_end - h (m_1 - m)/(m_1 - m_0).
#include <Eigen/Eigenvalues>

#include "mechanics/active/shape_activation.hpp"
#include "mechanics/derivatives.hpp"

namespace plica {

std::vector<double> ShapeActivation::by_values(std::vector<double> by_read) const {
  if (neighbours_.empty()) return by_read;
  std::vector<double> gradient(by_read.size(), 0.0);
  for (std::size_t c = 0; c < by_read.size(); ++c)
    for (const CellId from : neighbours_[c])
      gradient[from.index()] += by_read[c] / static_cast<double>(neighbours_[c].size());
  return gradient;
}

std::vector<double> ShapeActivation::after_like(const Step& step, std::span<const double> before,
                                                std::span<const double> next) const {
  std::vector<double> state = internal(step.positions, step.end_time_s, before);
  if (!starts() || rule_.signal) return state;
  const std::vector<double> from = read(ratios(step.previous_positions)), to = read(ratios(step.positions));
  for (std::size_t c = 0; c < state.size(); ++c) {
    state[c] = before[c];
    if (before[c] == not_yet && next[c] != not_yet)
      state[c] = step.end_time_s - step.length_s() * (to[c] - rule_.threshold) / (to[c] - from[c]);
  }
  return state;
}

void ShapeActivation::move_to_signals(std::span<double> by_state, std::span<const CellArray> signals,
                                      std::span<CellArray> by_signals) const {
  if (!rule_.signal || starts()) return;
  const std::vector<double> seen = read(signals[*rule_.signal]);
  std::vector<double> by_seen(seen.size(), 0.0);
  for (std::size_t c = 0; c < seen.size(); ++c) {
    const double part = progress(seen[c]);
    if (part > 0 && part < 1) by_seen[c] = by_state[c] / (rule_.to - rule_.from);
    by_state[c] = 0;
  }
  by_seen = by_values(std::move(by_seen));
  for (std::size_t c = 0; c < seen.size(); ++c) by_signals[*rule_.signal][c] += by_seen[c];
}

void ShapeActivation::add_gradient(const Step& step, std::span<const double> next, std::span<const double> adjoint,
                                   std::span<Vec3> positions, const BeginningGradient& gradient) const {
  if (rule_.signal) return;  // it has been moved to the signal
  const std::vector<double> to = read(ratios(step.positions)), from = read(ratios(step.previous_positions));
  const std::span<const double> before = step.internal;
  std::vector<double> by_to(to.size(), 0.0), by_from = by_to;
  for (std::size_t c = 0; c < to.size(); ++c) {
    if (!starts()) {
      const double part = progress(to[c]);
      if (part > 0 && part < 1) by_to[c] = adjoint[c] / (rule_.to - rule_.from);
    } else if (before[c] != not_yet || next[c] == not_yet) {
      gradient.internal[c] += adjoint[c];
    } else {
      const double change = to[c] - from[c], later = -adjoint[c] * step.length_s() / (change * change);
      by_to[c] = later * (rule_.threshold - from[c]);
      by_from[c] = later * (to[c] - rule_.threshold);
    }
  }
  add_ratio_gradient(step.positions, by_values(std::move(by_to)), positions);
  if (starts()) add_ratio_gradient(step.previous_positions, by_values(std::move(by_from)), gradient.previous);
}

void ShapeActivation::add_ratio_gradient(std::span<const Vec3> x, std::span<const double> weights,
                                         std::span<Vec3> gradient) const {
  const auto weight = [&](std::size_t c) { return at_rest_[c] > 0 ? weights[c] / at_rest_[c] : 0; };
  for (const Facet& facet : facets_) {
    const double of_area = weight(facet.cell.index());
    if (of_area == 0) continue;
    const std::array<Vec3, 4> by_corner = facet_area_gradient(gather(x, facet));
    for (int i = 0; i < 4; ++i) gradient[facet.nodes[i].index()] += of_area * by_corner[i];
  }
  for (std::size_t c = 0; c < edges_.size(); ++c)
    for (const auto& [base, apex] : edges_[c]) {
      const Vec3 along = (x[apex.index()] - x[base.index()]).normalized();
      const double of_length = weight(c) / static_cast<double>(edges_[c].size());
      gradient[apex.index()] += of_length * along;
      gradient[base.index()] -= of_length * along;
    }
  for (std::size_t c = 0; c < apices_.size(); ++c) {
    if (weight(c) == 0) continue;
    const Eigen::Matrix<double, 3, 2> stretch = apical_stretch(c, x);
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> squares(stretch.transpose() * stretch);
    const Eigen::Vector2d along = squares.eigenvectors().col(1);
    const Vec3 turned = (stretch * along).normalized();
    for (std::size_t i = 0; i < apices_[c].size(); ++i)
      gradient[apices_[c][i].index()] += weight(c) * gradients_[c][i].dot(along) * turned;
  }
}

}  // namespace plica
