#include "solver/linear/direct_directions.hpp"

#include <algorithm>
#include <cmath>

namespace plica {

DirectDirections::DirectDirections(const Model& model) : model_(model), contacts_(model) {}

// Laws may join other nodes than in the step before.
void DirectDirections::prepare(const Step& step) {
  if (matrix_ && matrix_->serves(model_, step)) return;
  forget_factor();
  matrix_ = std::make_unique<StepMatrix>(model_, step);
  linear_solver_ = make_direct_solver();
  linear_solver_->analyse(matrix_->pattern());
}

bool DirectDirections::refresh(const Step& step, const Iterate& at) {
  factor_frames_ = node_frames(model_, contacts_, at);
  factor_contacts_ = at.in_contact;
  factor_rate_s_ = step.rate_s;
  matrix_->assemble(model_, contacts_, step, at);
  matrix_->write_values(factor_frames_, values_);
  if (!linear_solver_->factorise(values_)) {
    forget_factor();
    return false;
  }
  border_dense_rows();
  return true;
}

// Unknowns of the factor: three a free node, in its frame, then one a sparse row of J.
void DirectDirections::border_dense_rows() {
  const ConstraintJacobian& J = matrix_->jacobian();
  const std::size_t nodes = factor_frames_.size();
  std::vector<std::vector<double>> rows(J.dense_rows(), std::vector<double>(3 * nodes + J.sparse_rows(), 0.0));
  for (std::size_t row = 0; row < rows.size(); ++row)
    for (std::size_t n = 0; n < nodes; ++n) {
      const Vec3 local = factor_frames_[n].axes.transpose() * J.dense_row(row)[n];
      for (int i = factor_frames_[n].fixed; i < 3; ++i) rows[row][3 * n + i] = local[i];
    }
  dense_.begin(std::move(rows), [&](std::span<double> x) { linear_solver_->solve(x); });
}

NewtonDirections::Status DirectDirections::find(const Step& step, const Iterate& at, const Residual& residual,
                                                const ForcingTermInput& forcing, Direction& direction, Cost& cost) {
  prepare(step);
  // A factor of a step of nearly this length converges nearly as fast; of other contacts it has the wrong unknowns.
  constexpr double alike = 0.2;
  const bool stale =
      factor_frames_.empty() || std::abs(factor_rate_s_ / step.rate_s - 1) > alike || factor_contacts_ != at.in_contact;
  const bool slow = forcing.residual_reduction > 0.1;  // less than Newton's method can
  if (stale || slow) {
    ++cost.factorisations;
    if (!refresh(step, at)) return Status::singular;
  }
  ++cost.linear_solves;

  const ConstraintJacobian& J = matrix_->jacobian();
  const std::size_t nodes = factor_frames_.size(), sparse = J.sparse_rows();
  std::vector<double> unknowns(3 * nodes + J.rows(), 0.0);
  for (std::size_t n = 0; n < nodes; ++n) {
    const Vec3 local = factor_frames_[n].axes.transpose() * residual.forces[n];
    for (int i = factor_frames_[n].fixed; i < 3; ++i) unknowns[3 * n + i] = local[i];
  }
  const std::span<double> of_rows = std::span(unknowns).subspan(3 * nodes);
  for (std::size_t row = 0; row < J.rows(); ++row) of_rows[row] = -residual.deficits[J.multiplier(row)];
  const std::span<double> of_factor = std::span(unknowns).first(3 * nodes + sparse);
  linear_solver_->solve(of_factor);
  if (!dense_.empty()) dense_.apply(of_factor, of_rows.subspan(sparse));

  direction.positions.assign(at.positions.size(), Vec3::Zero());
  for (std::size_t n = 0; n < nodes; ++n)
    direction.positions[n] = factor_frames_[n].axes * Vec3(unknowns[3 * n], unknowns[3 * n + 1], unknowns[3 * n + 2]);
  model_.tissue.place_hanging(direction.positions);
  direction.multipliers.assign(at.multipliers.size(), 0.0);
  for (std::size_t row = 0; row < J.rows(); ++row) direction.multipliers[J.multiplier(row)] = of_rows[row];
  return Status::found;
}

}  // namespace plica
