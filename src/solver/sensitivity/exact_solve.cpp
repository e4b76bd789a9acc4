#include "solver/sensitivity/exact_solve.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace plica {

ExactSolve::ExactSolve(const Model& model, LinearMethod method)
    : model_(model), system_(model), directions_(make_directions(model, method, {})) {}

ExactSolve::Solution ExactSolve::solve(const Step& step, const Iterate& at, std::span<const Vec3> forces,
                                       double tolerance) {
  system_.take(step, at);
  const ConstraintJacobian& J = system_.jacobian();
  std::vector<double> weights;
  for (std::size_t row = 0; row < J.rows(); ++row) weights.push_back(model_.force_scale() / J.gradient_scale(row));
  system_.set_units(weights);

  KrylovVector right(system_.size(), 0.0);
  std::ranges::copy(forces, system_.of_nodes(right).begin());
  system_.project(system_.of_nodes(right));
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
                       solution_);
  if (!report.converged) throw std::runtime_error("gradient: the linear system of a step was not solved accurately");

  Solution result;
  result.positions.assign(system_.of_nodes(std::as_const(solution_)).begin(),
                          system_.of_nodes(std::as_const(solution_)).end());
  result.multipliers.assign(at.multipliers.size(), 0.0);
  const std::span<const double> rows = system_.of_rows(std::as_const(solution_));
  for (std::size_t row = 0; row < rows.size(); ++row) result.multipliers[J.multiplier(row)] = rows[row];
  return result;
}

Vectors ExactSolve::unbalanced(const Step& step, const Iterate& at, std::span<const Vec3> forces) const {
  Vectors left(forces.size());
  system_.multiply_unprojected(step, at, solution_, left);
  for (std::size_t n = 0; n < left.size(); ++n) left[n] = forces[n] - left[n];
  return left;
}

}  // namespace plica
