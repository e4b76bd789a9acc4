#include "solver/sensitivity/exact_solve.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "core/parallel.hpp"

namespace plica {

ExactSolve::ExactSolve(const Model& model, LinearMethod method)
    : model_(model), system_(model), directions_(make_directions(model, method, {})) {}

KrylovVector ExactSolve::right_of(const Step& step, const Iterate& at, const RightSide& input) {
  KrylovVector right(system_.size(), 0.0);
  solution_.assign(system_.size(), 0.0);
  if (!input.fixed.empty()) {
    std::ranges::copy(input.fixed, system_.of_nodes(solution_).begin());
    system_.multiply(step, at, solution_, right);
    for (double& number : right) number = -number;
  }
  const std::span<Vec3> forces = system_.of_nodes(right);
  for (std::size_t n = 0; n < forces.size(); ++n) forces[n] += input.forces[n];
  system_.project(forces);
  const std::span<double> rows = system_.of_rows(right);
  for (std::size_t row = 0; row < rows.size() && !input.rates.empty(); ++row)
    rows[row] -= system_.units()[row] * input.rates[system_.jacobian().multiplier(row)];
  return right;
}

ExactSolve::Solution ExactSolve::solve(const Step& step, const Iterate& at, const RightSide& input, double tolerance) {
  system_.take(step, at);
  const ConstraintJacobian& J = system_.jacobian();
  std::vector<double> weights;
  for (std::size_t row = 0; row < J.rows(); ++row) weights.push_back(model_.force_scale() / J.gradient_scale(row));
  system_.set_units(weights);
  const KrylovVector right = right_of(step, at, input);
  if (parallel_dot(right, right) > 0) correct(step, at, right, tolerance);

  Solution result;
  result.positions.assign(system_.of_nodes(std::as_const(solution_)).begin(),
                          system_.of_nodes(std::as_const(solution_)).end());
  result.multipliers.assign(at.multipliers.size(), 0.0);
  const std::span<const double> rows = system_.of_rows(std::as_const(solution_));
  for (std::size_t row = 0; row < rows.size(); ++row) result.multipliers[J.multiplier(row)] = rows[row];
  return result;
}

void ExactSolve::correct(const Step& step, const Iterate& at, const KrylovVector& right, double tolerance) {
  const ConstraintJacobian& J = system_.jacobian();
  Residual residual;
  Direction direction;
  double left = 1;  // of the right side
  const auto precondition = [&](const KrylovVector& r, KrylovVector& z) {
    residual.forces.assign(system_.of_nodes(r).begin(), system_.of_nodes(r).end());
    residual.deficits.assign(at.multipliers.size(), 0.0);
    const std::span<const double> rows = system_.of_rows(r);
    for (std::size_t row = 0; row < rows.size(); ++row)
      residual.deficits[J.multiplier(row)] = -rows[row] / system_.units()[row];
    // Somewhat more accurate than needed, since norms differ in the units of rows.
    const double needed = std::clamp(0.3 * tolerance / left, 1e-14, 0.1);
    if (directions_->find(step, at, residual, {0, needed, true}, direction, cost_) != NewtonDirections::Status::found)
      throw std::runtime_error("gradient: the linear system of a step is singular");
    z.assign(r.size(), 0.0);
    std::ranges::copy(direction.positions, system_.of_nodes(z).begin());
    for (std::size_t row = 0; row < rows.size(); ++row)
      system_.of_rows(z)[row] = direction.multipliers[J.multiplier(row)];
  };
  const KrylovReport report =
      residuals_.solve([&](const KrylovVector& p, KrylovVector& q) { system_.multiply(step, at, p, q); }, precondition,
                       right, {.tolerance = tolerance, .most_iterations = 30},
                       [&](const KrylovReport& so_far) {
                         left = so_far.residual;
                         return true;
                       },
                       correction_);
  if (!report.converged) throw std::runtime_error("gradient: the linear system of a step was not solved accurately");
  for (std::size_t i = 0; i < solution_.size(); ++i) solution_[i] += correction_[i];
}

Vectors ExactSolve::unbalanced(const Step& step, const Iterate& at, std::span<const Vec3> forces) const {
  Vectors left(forces.size());
  system_.multiply_unprojected(step, at, solution_, left);
  for (std::size_t n = 0; n < left.size(); ++n) left[n] = forces[n] - left[n];
  return left;
}

}  // namespace plica
