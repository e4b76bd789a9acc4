// How a step in time is taken: the interface of all schemes, and what a step reports.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "mechanics/model.hpp"
#include "solver/linear/iterate.hpp"
#include "solver/step/backward_difference.hpp"

namespace plica {

/// How a step went. A value: a step that fails is not an exception, the caller tries a shorter one.
struct StepReport {
  enum class Outcome {
    converged,
    inverted_element,
    no_convergence,
    no_linear_convergence,
    singular_system,
    not_projected,
    not_finite,
    interrupted
  };
  Outcome outcome = Outcome::no_convergence;
  int refused = 0;  // attempts before this one, which were too long
  int newton_iterations = 0;
  int factorisations = 0;
  int linear_solves = 0;        // back substitutions of a factor, or iterations of conjugate gradients
  double residual = 0;          // relative: of the forces (Newton) or of the linear system (linearly implicit)
  double constraint_error = 0;  // largest relative one
  double outside_um = 0;        // how far a node is left beyond an obstacle by the projection
  int projection_sweeps = 0;
  int cubics = 0;                   // solved by the projection,
  int cubics_with_three_roots = 0;  // and how many of them had three real roots
  std::optional<CellId> cell;       // where it failed, when that is one place

  [[nodiscard]] bool converged() const { return outcome == Outcome::converged; }
  /// "cell 37 turns inside out" and the like.
  [[nodiscard]] std::string reason() const;
  /// What to try, with the keys of the scenario that matter; empty where nothing is known.
  [[nodiscard]] std::string remedy() const;
};

/// Takes steps of one model.
class Stepper {
 public:
  virtual ~Stepper() = default;

  /// From `state` over `duration_s` to `next` (left alone when the step fails). A start may be guessed from the
  /// velocities unless `from_rest`.
  virtual StepReport advance(const State& state, double duration_s, bool from_rest, State& next) = 0;

  /// A step asks this now and then; once true it ends as interrupted.
  virtual void stop_when(std::function<bool()> stop_requested) = 0;

  /// Forgets a factor that was kept, so that the next step does not depend on what was solved before.
  virtual void forget_factor() {}

  /// What is kept between steps, and the same taken up again by a stepper that has just been made (NewtonDirections).
  [[nodiscard]] virtual FactorMemory memory() const { return {}; }
  virtual void recall(const FactorMemory& /*memory*/) {}
};

/// A cell at the node with the largest vector; one that is not finite goes before all others.
std::optional<CellId> cell_with_largest(const Tissue& tissue, std::span<const Vec3> vectors);

/// The first cell that has an element inside out or flat.
std::optional<CellId> inverted_cell(const Tissue& tissue, const Vectors& positions);

}  // namespace plica
