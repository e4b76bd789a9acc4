// Solved steps of a run, as the way back reads them.
#pragma once

#include <vector>

#include "solver/linear/directions.hpp"
#include "solver/step/newton_stepper.hpp"

namespace plica {

/// State between two steps.
struct TapedState {
  double time_s = 0;
  Vectors positions;                           // nodes; um
  std::vector<double> multipliers;             // all constraints
  std::vector<double> obstacle_forces;         // ObstacleContacts; nN
  std::vector<char> on_obstacle;               // ObstacleContacts
  std::vector<std::vector<double>> internals;  // laws

  /// Take what the way back needs of a state.
  static TapedState of(const State& state);
};

/// Run of one model: its states, and how rates were formed in the steps between them.
struct TapedRun {
  std::vector<TapedState> states;         // steps + 1
  std::vector<BackwardDifference> rates;  // steps

  [[nodiscard]] std::size_t steps() const { return rates.size(); }
  /// Step n, from state n to state n + 1: a view of this run.
  [[nodiscard]] Step step(std::size_t n) const;
  /// Solved iterate of step n.
  [[nodiscard]] Iterate at_end_of(std::size_t n) const;
};

/// Numerical method of a run.
struct RunMethod {
  LinearMethod linear_method = LinearMethod::automatic;
  TimeOrder order = TimeOrder::first;
};

/// Run a model, of the same tissue, through the steps of another run: the same ends and orders, solved as accurately as
/// rounding allows, and halved where they do not converge. Throws std::runtime_error if halves do not either.
TapedRun replayed(const Model& model, const TapedRun& like, const RunMethod& method);

}  // namespace plica
