// One implicit step, of first or second order in time, with forces, constraints and obstacles solved together (THE
// NEWTON LOOP).
//
// The step ends where  -dPhi/dx + J^T lambda + N mu = 0,  c = target,  0 <= g _|_ mu >= 0,  Phi being the sum of the
// laws' energies. Newton's method for all of it at once, with line search; obstacles by an active set that is revised
// after each iteration. Theory: docs/theory/step.md.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "mechanics/model.hpp"
#include "solver/linear/directions.hpp"
#include "solver/linear/iterate.hpp"
#include "solver/step/backward_difference.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// Convergence tolerances of a step.
struct StepTolerances {
  double force = 1e-8;        // residual / norm of the balancing forces
  double constraint = 1e-10;  // |value/target - 1| of every held function
  double gap_um = 1e-8;       // penetration of a node into an obstacle
  int max_iterations = 40;
};

class Balance;

/// Stepper of one model; keeps data shared by linear systems of successive steps.
class NewtonStepper final : public Stepper {
 public:
  explicit NewtonStepper(const Model& model, StepTolerances tolerances = {},
                         LinearMethod method = LinearMethod::automatic, TimeOrder order = TimeOrder::first);
  ~NewtonStepper() override;

  /// Solve a step, starting from a prediction by velocities unless `from_rest`.
  StepReport advance(const State& state, double duration_s, bool from_rest, State& next,
                     const Model* grown = nullptr) override;
  void stop_when(std::function<bool()> stop_requested) override { stop_requested_ = std::move(stop_requested); }
  void forget_factor() override;
  [[nodiscard]] bool keeps_factor() const override { return directions_->keeps_factor(); }

 private:
  struct Attempt;
  [[nodiscard]] Iterate forecast(const State& state, double duration_s) const;
  void start(const State& state, double duration_s, bool from_rest, Attempt& attempt) const;
  bool iterate(Attempt& attempt);
  bool improve(Attempt& attempt);
  std::optional<double> search_line(const Direction& direction, Attempt& attempt) const;
  void take_residual(Attempt& attempt) const;
  bool settle_contacts(Attempt& attempt) const;
  bool give_up(Attempt& attempt, StepReport::Status status) const;
  void accept(const State& state, const Step& step, double duration_s, TimeOrder order, Iterate at, State& next) const;

  const Model& model_;
  StepTolerances tolerances_;
  TimeOrder order_;
  std::unique_ptr<Balance> balance_;
  std::unique_ptr<NewtonDirections> directions_;
  std::function<bool()> stop_requested_;
};

}  // namespace plica
