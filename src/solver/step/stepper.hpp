// Interface of all time-stepping schemes, and the report of a step.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mechanics/model.hpp"
#include "solver/linear/iterate.hpp"
#include "solver/step/backward_difference.hpp"

namespace plica {

/// Report of a step. A failed step is a value, not an exception; the caller retries with a shorter one.
struct StepReport {
  enum class Status {
    converged,
    inverted_element,
    no_convergence,
    no_linear_convergence,
    singular_system,
    not_projected,
    not_finite,
    interrupted
  };
  Status status = Status::no_convergence;
  int refused = 0;  // rejected attempts before this one
  int newton_iterations = 0;
  int factorisations = 0;
  int linear_solves = 0;        // solves with a factorization, or conjugate-gradient iterations
  double residual = 0;          // relative: forces (Newton) or linear system (linearly implicit)
  double constraint_error = 0;  // largest relative error of a constraint
  double outside_um = 0;        // largest distance of a node beyond an obstacle after the projection
  int projection_sweeps = 0;
  int cubics = 0;                   // solved by the projection
  int cubics_with_three_roots = 0;  // of these, with three real roots
  std::optional<CellId> cell;       // cell of the failure, if it is one cell

  [[nodiscard]] bool converged() const { return status == Status::converged; }
  /// Cause of a failure, for example "cell 37 becomes inverted".
  [[nodiscard]] std::string reason() const;
};

/// Time stepper of one model.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// Advance `state` by `duration_s` to `next` (unchanged on failure). Unless `from_rest`, the iteration may start from
  /// a prediction by the velocities. `grown`: the model at the end of the step; null: its
  /// model, which does not grow.
  virtual StepReport advance(const State& state, double duration_s, bool from_rest, State& next,
                             const Model* grown = nullptr) = 0;

  /// `stop_requested` is polled during a step; once true, the step ends as interrupted.
  virtual void stop_when(std::function<bool()> stop_requested) = 0;

  /// Discard a reused factorization, so that the next step does not depend on earlier solves.
  virtual void forget_factor() {}

  /// Whether the next step may reuse a factorization.
  [[nodiscard]] virtual bool keeps_factor() const { return false; }
};

/// Cell at the node with the largest vector; vectors that are not finite come first.
std::optional<CellId> cell_with_largest(const Tissue& tissue, std::span<const Vec3> vectors);

/// First cell with an inverted or flat element.
std::optional<CellId> inverted_cell(const Tissue& tissue, const Vectors& positions);

}  // namespace plica
