// Newton directions by conjugate residuals with products of the laws: the system (linearised_system.hpp) is
// matrix-free; only its preconditioner is assembled, and reused over steps.
#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "solver/algebra/krylov.hpp"
#include "solver/linear/directions.hpp"
#include "solver/linear/kept_preconditioner.hpp"

namespace plica {
namespace {

constexpr double far_from_balance = 0.1;  // residual's forces, relative

/// Relative tolerance of the linear solve: as the residual falls, the direction's error must fall with it; it may be
/// larger where Newton's method converges slowly (Eisenstat and Walker 1996, choice 2).
double useful_tolerance(const Residual& residual, const NewtonDirections::ForcingTermInput& forcing) {
  const double useful = std::clamp(
      std::max(0.05 * residual.force, 0.5 * forcing.residual_reduction * forcing.residual_reduction), 1e-4, 1e-2);
  return std::clamp(forcing.relative_tolerance, useful, 0.1);
}

/// Return the part of the right side's norm that forces have; the rest are errors of constraints, in units of
/// pressures.
double share_of_forces(const KrylovVector& right, std::size_t nodes) {
  const std::span<const double> all(right), forces = all.first(3 * nodes);
  return std::sqrt(parallel_dot(forces, forces) / parallel_dot(all, all));
}

/// Relative tolerance of the full system. In a short step drag makes it stiff, and errors of constraints weigh
/// thousands of times those of forces (up to a factor of a thousand, their weights leave forces accurate enough).
/// Forces have to be solved as well: a direction that mends constraints alone may raise the residual at every length.
double tolerance_of_whole(const Residual& residual, NewtonDirections::ForcingTermInput forcing, double share) {
  if (forcing.is_exact) return forcing.relative_tolerance;
  constexpr double least_share = 1e-3, part_unsolved = 0.3;
  if (share < least_share) forcing.relative_tolerance *= share / least_share;
  return std::min(useful_tolerance(residual, forcing), part_unsolved * std::max(share, least_share));
}

/// Part of the iterations of a solve to 1e-4 that a solve to this residual takes, if each reduces it alike.
double share_of_solve(double residual) { return std::clamp(std::log10(residual) / -4, 0.1, 4.0); }

class KrylovDirections final : public NewtonDirections {
 public:
  KrylovDirections(const Model& model, LinearMethod method, std::function<bool()> stop_requested)
      : model_(model),
        stop_requested_(std::move(stop_requested)),
        method_(method),
        system_(model),
        price_of_new_(method == LinearMethod::multigrid ? 5 : 30) {}
  [[nodiscard]] Status find(const Step& step, const Iterate& at, const Residual& residual,
                            const ForcingTermInput& forcing, Direction& direction, Cost& cost) override {
    system_.take(step, at);
    Solve solve{step, at, cost};
    if (!keeps_factor() || !kept_->follow_contacts(at))
      renew(solve, at_beginning);
    else
      kept_->border_dense_rows();
    iterate(solve, residual, forcing);
    if (!is_made_) return Status::singular;
    if (solve.report.interrupted) return Status::interrupted;
    // An inexact direction is still one; the line search judges it.
    if (!(solve.report.residual < 0.5)) return Status::singular;
    take_cost(solve);
    direction = system_.direction_of(solve.solution, at.multipliers.size());
    return Status::found;
  }
  // A borrowed order goes as well: resumed runs find their own, and have to be bitwise identical.
  void forget_factor() override {
    is_made_ = false;
    if (kept_ && kept_->has_borrowed_order()) kept_.reset();
  }
  [[nodiscard]] bool keeps_factor() const override { return is_made_ && wasted_iterations_ <= price_of_new_; }

 private:
  static constexpr KrylovReport at_beginning{.residual = 1};
  /// One solve, and its preconditioner if that is made for it.
  struct Solve {
    const Step& step;
    const Iterate& at;
    Cost& cost;
    bool is_new = false;                     // the preconditioner
    KrylovReport before_new = at_beginning;  // where the solve was when it was made
    KrylovReport report = {};
    KrylovVector solution = {};
  };
  void renew(Solve& solve, const KrylovReport& so_far) {
    ++solve.cost.factorisations;
    fit_pattern(solve.step);
    is_made_ = kept_->make(solve.step, solve.at);
    solve.is_new = true;
    solve.before_new = so_far;
  }
  /// Iterate, with a new preconditioner or the semidefinite tangent where needed.
  void iterate(Solve& solve, const Residual& residual, const ForcingTermInput& forcing) {
    // With a direction of negative curvature, iterations lead to a saddle or do not end. Far from balance the
    // semidefinite tangent is used instead; close to it Newton's method needs the exact tangent.
    Step here = solve.step;
    bool is_indefinite = false;
    const auto multiply = [&](const KrylovVector& p, KrylovVector& q) {
      system_.multiply(here, solve.at, p, q);
      if (residual.force > far_from_balance && !here.semidefinite_tangent &&
          system_.curvature(p, q, kept_->weights()) < 0)
        is_indefinite = true;
    };
    const auto go_on = [&](const KrylovReport& so_far) {
      if (!solve.is_new && wasted(so_far) > 3 * price_of_new_) renew(solve, so_far);
      return is_made_ && !is_indefinite && !(stop_requested_ && stop_requested_());
    };
    while (true) {
      system_.set_units(kept_->weights());  // and not on the way, should weights become others
      const KrylovVector right = system_.right_side(residual);
      const double share = share_of_forces(right, solve.at.positions.size());
      solve.report = solver_.solve(
          multiply, [&](const KrylovVector& r, KrylovVector& z) { kept_->apply(r, z); }, right,
          {.tolerance = tolerance_of_whole(residual, forcing, share)}, go_on, solve.solution);
      solve.cost.linear_solves += solve.report.iterations;
      if (solve.report.converged) return;
      if (is_indefinite) {
        is_indefinite = false;
        here.semidefinite_tangent = true;
        solve.before_new = at_beginning;
      } else if (!solve.report.interrupted && !solve.is_new) {
        renew(solve, at_beginning);
      } else {
        return;
      }
    }
  }
  /// Take the iterations of a solve: what a new preconditioner needs, or an older one wastes.
  void take_cost(const Solve& solve) {
    if (!solve.is_new) {
      wasted_iterations_ += wasted(solve.report);
      return;
    }
    const double share = share_of_solve(solve.report.residual / solve.before_new.residual);
    iterations_when_new_ =
        static_cast<int>(std::lround((solve.report.iterations - solve.before_new.iterations) / share));
    wasted_iterations_ = 0;
  }
  /// Take new patterns: the preconditioner stays in use while it is good.
  void fit_pattern(const Step& step) {
    if (kept_ && kept_->serves(step)) return;
    kept_ = std::make_unique<KeptPreconditioner>(model_, system_, method_, step, is_made_ ? kept_.get() : nullptr);
  }
  /// Return the iterations of a solve that a new preconditioner would have saved.
  [[nodiscard]] int wasted(const KrylovReport& report) const {
    const long needed = std::lround(iterations_when_new_ * share_of_solve(report.residual));
    return std::max(0, report.iterations - static_cast<int>(needed));
  }

  const Model& model_;
  std::function<bool()> stop_requested_;
  LinearMethod method_;  // cholesky or multigrid
  LinearisedSystem system_;
  std::unique_ptr<KeptPreconditioner> kept_;  // for the patterns at its computation
  bool is_made_ = false;
  int price_of_new_;             // cost of a new one, in iterations, including assembly
  int iterations_when_new_ = 0;  // to 1e-4
  int wasted_iterations_ = 0;
  ConjugateResiduals solver_;
};

}  // namespace

std::unique_ptr<NewtonDirections> make_krylov_directions(const Model& model, LinearMethod method,
                                                         std::function<bool()> stop_requested) {
  return std::make_unique<KrylovDirections>(model, method, std::move(stop_requested));
}

}  // namespace plica
