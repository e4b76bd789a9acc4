// Solved steps of a run, as the way back reads them.
#pragma once

#include <optional>
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
  Signals::Values signals;                     // cells, by signal

  /// Take what the way back needs of a state.
  static TapedState of(const State& state);
};

/// Run of one model: its states, and how rates were formed in the steps between them.
struct TapedRun {
  std::vector<TapedState> states;         // steps + 1
  std::vector<BackwardDifference> rates;  // steps

  [[nodiscard]] std::size_t steps() const { return rates.size(); }
  /// Step n, from state n to state n + 1, without its grown model: a view of this run.
  [[nodiscard]] Step step(std::size_t n) const;
  /// Return a model of this run as grown at the end of step n, which follows from the time alone; empty if no cell has.
  [[nodiscard]] std::optional<Model> grown_in(std::size_t n, const Model& model) const {
    return grown(model, model, states.front().internals, states[n + 1].time_s);
  }
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
