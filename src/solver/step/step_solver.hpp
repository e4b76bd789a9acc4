// One implicit step, of first or second order in time, with exact volumes and the shell held together with the forces.
//
// The step ends where  -dPhi/dx + J^T lambda + N mu = 0,  V_c = target,  0 <= g _|_ mu >= 0,  Phi being the sum of the
// laws' energies. Newton's method on all of it at once, with line search; the shell by an active set that is revised
// after each iteration. Theory: docs/theory/step.md.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mechanics/model.hpp"
#include "solver/linear/newton.hpp"
#include "solver/step/backward_difference.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// When a step counts as solved.
struct StepTolerances {
  double force = 1e-8;    // residual over the norm of the forces that balance
  double volume = 1e-10;  // |V/target - 1|, every cell
  double gap_um = 1e-8;   // depth of a node outside the shell
  int max_iterations = 40;
};

/// Solves steps of one model; keeps what its linear systems have in common between them.
class StepSolver final : public Stepper {
 public:
  explicit StepSolver(const Model& model, StepTolerances tolerances = {}, LinearMethod method = LinearMethod::automatic,
                      TimeOrder order = TimeOrder::first);
  ~StepSolver() override;

  /// Starts from the velocities' forecast unless `from_rest`.
  StepReport advance(const State& state, double duration_s, bool from_rest, State& next) override;
  void stop_when(std::function<bool()> stop_requested) override { stop_requested_ = std::move(stop_requested); }
  void forget_factor() override;
  [[nodiscard]] FactorMemory memory() const override { return directions_->memory(); }
  void recall(const FactorMemory& memory) override { directions_->recall(memory); }

 private:
  [[nodiscard]] Iterate forecast(const State& state, double duration_s) const;
  [[nodiscard]] Residual residual(const Step& step, Iterate& at) const;
  bool revise_contacts(Iterate& at) const;
  bool search_line(const Step& step, const Direction& direction, Iterate& at, Residual& now, StepReport& report) const;

  const Model& model_;
  StepTolerances tolerances_;
  TimeOrder order_;
  double force_scale_;      // nN
  double force_rounding_;   // nN: what rounding of positions makes of forces
  double volume_rounding_;  // the same, of relative volumes
  std::unique_ptr<NewtonDirections> directions_;
  std::function<bool()> stop_requested_;
};

}  // namespace plica
