#include "solver/linear/krylov_directions.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace plica {
namespace {

constexpr double far_from_balance = 0.1;  // residual's forces, relative

/// To which Newton's method can use a direction: its own error leaves a part of the residual that falls with the
/// residual itself; more where it has been seen to converge slowly (Eisenstat and Walker 1996, choice 2).
double useful_tolerance(const Residual& residual, const NewtonDirections::ForcingTermInput& forcing) {
  const double useful = std::clamp(
      std::max(0.05 * residual.force, 0.5 * forcing.residual_reduction * forcing.residual_reduction), 1e-4, 1e-2);
  return std::clamp(forcing.relative_tolerance, useful, 0.1);
}

/// Accuracy of the full system that gives its forces `accuracy`. In a short step, where drag makes the system stiff,
/// what constraints lack weighs thousands of times what is unbalanced. (Up to a thousand times, as their weights have
/// it, forces come out well enough.)
double accuracy_of_whole(double accuracy, const KrylovVector& right, std::size_t nodes) {
  const std::span<const double> all(right), forces = all.first(3 * nodes);
  const double share = std::sqrt(parallel_dot(forces, forces) / parallel_dot(all, all));
  return share < 1e-3 ? accuracy * 1e3 * share : accuracy;
}

/// The share that reducing the residual to this has of a solve to 1e-4.
double share_of_solve(double residual) { return std::clamp(std::log10(residual) / -4, 0.1, 4.0); }

}  // namespace

KrylovDirections::KrylovDirections(const Model& model, Inverse inverse, std::function<bool()> stop_requested)
    : model_(model),
      stop_requested_(std::move(stop_requested)),
      inverse_(inverse),
      system_(model),
      price_of_new_(inverse == Inverse::multigrid ? 5 : 30) {}

void KrylovDirections::fit_pattern(const Step& step) {
  if (!kept_ || !kept_->serves(step)) kept_ = std::make_unique<KeptPreconditioner>(model_, system_, inverse_, step);
}

int KrylovDirections::wasted(const KrylovReport& report) const {
  const long needed = std::lround(iterations_when_new_ * share_of_solve(report.residual));
  return std::max(0, report.iterations - static_cast<int>(needed));
}

NewtonDirections::Status KrylovDirections::find(const Step& step, const Iterate& at, const Residual& residual,
                                                const ForcingTermInput& forcing, Direction& direction, Cost& cost) {
  system_.take(step, at);
  constexpr KrylovReport at_beginning{.residual = 1};
  KrylovReport before_new = at_beginning;  // where the solve was when the preconditioner was made
  bool is_new = false;
  const auto renew = [&](const KrylovReport& so_far) {
    ++cost.factorisations;
    fit_pattern(step);
    is_made_ = kept_->make(step, at);
    is_new = true;
    before_new = so_far;
  };
  if (!keeps_factor() || !kept_->follow_contacts(at))
    renew(at_beginning);
  else
    kept_->border_dense_rows();

  // Where energy curves down along some direction, that leads to a saddle, if anywhere, and iterations do not end: far
  // from balance the semidefinite tangent shows the way. Near it Newton's method needs all of the tangent.
  Step here = step;
  bool is_indefinite = false;
  const auto multiply = [&](const KrylovVector& p, KrylovVector& q) {
    system_.multiply(here, at, p, q);
    if (residual.force > far_from_balance && !here.semidefinite_tangent &&
        system_.curvature(p, q, kept_->weights()) < 0)
      is_indefinite = true;
  };
  const auto go_on = [&](const KrylovReport& so_far) {
    if (!is_new && wasted(so_far) > 3 * price_of_new_) renew(so_far);
    return is_made_ && !is_indefinite && !(stop_requested_ && stop_requested_());
  };
  KrylovReport report;
  KrylovVector solution;
  while (true) {
    system_.set_units(kept_->weights());  // and not on the way, should weights become others
    const KrylovVector right = system_.right_side(residual);
    const double accuracy = accuracy_of_whole(forcing.relative_tolerance, right, at.positions.size());
    report = solver_.solve(
        multiply, [&](const KrylovVector& r, KrylovVector& z) { kept_->apply(r, z); }, right,
        {.tolerance = useful_tolerance(residual, {forcing.residual_reduction, accuracy})}, go_on, solution);
    cost.linear_solves += report.iterations;
    if (report.converged) break;
    if (is_indefinite) {
      is_indefinite = false;
      here.semidefinite_tangent = true;
      before_new = at_beginning;
    } else if (!report.interrupted && !is_new) {
      renew(at_beginning);
    } else {
      break;
    }
  }
  if (!is_made_) return Status::singular;
  if (report.interrupted) return Status::interrupted;
  // An inexact direction is still one; the line search judges it.
  if (!(report.residual < 0.5)) return Status::singular;
  if (is_new) {
    const double share = share_of_solve(report.residual / before_new.residual);
    iterations_when_new_ = static_cast<int>(std::lround((report.iterations - before_new.iterations) / share));
    wasted_iterations_ = 0;
  } else {
    wasted_iterations_ += wasted(report);
  }
  direction = system_.direction_of(solution, at.multipliers.size());
  return Status::found;
}

}  // namespace plica
