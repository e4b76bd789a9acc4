// Solved steps of a run, as the way back reads them.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "mechanics/division.hpp"
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
  Vectors earlier = {};                   // nodes: positions one step before the first state; um; empty if unknown

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

/// Divisions and exchanges at one time.
struct TapedChange {
  State before;
  std::vector<RepeatedChange> again;  // in their order

  /// Make them again, for a model and a state as `before`. Throws NoGradient if they cannot be made.
  void make(Model& model, State& state) const;
};

/// Part of a run between changes of its tissue, with its solved model.
struct TapedPart {
  std::shared_ptr<const Model> model;
  TapedRun run;
  std::optional<TapedChange> change = {};  // with which it begins; none at the start
  std::size_t first_state = 0;             // number in the whole run of its first state, that after the change
};

/// Return the part that has a state of a run, by its number.
std::size_t part_with(std::span<const TapedPart> parts, std::size_t state);

/// Return positions one step before a state, empty where none are known.
Vectors known_earlier_positions(const State& state);

/// Numerical method of a run.
struct RunMethod {
  LinearMethod linear_method = LinearMethod::automatic;
  TimeOrder order = TimeOrder::first;
};

/// Run a model, of the same tissue, through the steps and changes of another run: the same ends and orders, solved as
/// accurately as rounding allows, and halved where they do not converge. Throws std::runtime_error if halves do not
/// either, NoGradient if changes have another result.
std::vector<TapedPart> replayed(std::shared_ptr<const Model> model, std::span<const TapedPart> like,
                                const RunMethod& method);

/// Throw NoGradient unless a change led to a model and state of the same tissue as in the run, `like`.
void require_same_change(const Model& model, const State& state, const TapedPart& like);

}  // namespace plica
