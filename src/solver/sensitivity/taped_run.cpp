#include "solver/sensitivity/taped_run.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <utility>

namespace plica {

TapedState TapedState::of(const State& state) {
  return {state.time_s,      state.positions, state.multipliers, state.obstacle_forces,
          state.on_obstacle, state.internals, state.signals};
}

Step TapedRun::step(std::size_t n) const {
  const TapedState &begin = states[n], &end = states[n + 1];
  return {.positions = end.positions,
          .previous_positions = begin.positions,
          .previous_velocities = {},
          .rate_s = rates[n].rate_s,
          .end_time_s = end.time_s,
          .earlier_positions =
              rates[n].ahead > 0 ? std::span<const Vec3>(states[n - 1].positions) : std::span<const Vec3>(),
          .ahead = rates[n].ahead,
          .internals = begin.internals};
}

Iterate TapedRun::at_end_of(std::size_t n) const {
  const TapedState& end = states[n + 1];
  return {end.positions, end.multipliers, end.obstacle_forces, end.on_obstacle};
}

namespace {

/// Repeats steps with one model, as accurately as rounding allows.
class Replay {
 public:
  Replay(const Model& model, const RunMethod& method) : model_(model), now_(rest_state(model)) {
    // Where contacts change, rounding may stop Newton's method before the first of these.
    for (const double force : {1e-12, 1e-10, 1e-8})
      steppers_.push_back(std::make_unique<NewtonStepper>(
          model, StepTolerances{.force = force, .constraint = 0.1 * force, .gap_um = 1e-11, .max_iterations = 60},
          method.linear_method, method.order));
    run_.states.push_back(TapedState::of(now_));
  }

  /// Step to a time, in halves if need be.
  void go_to(double end_s, bool is_first_order, int halvings = 0) {
    constexpr int most_halvings = 6;
    if (is_first_order) now_.trend = {};
    State next;
    StepReport report;
    const std::optional<Model> later = grown(model_, model_, run_.states.front().internals, end_s);
    for (const auto& stepper : steppers_) {
      report = stepper->advance(now_, end_s - now_.time_s, run_.steps() == 0, next, later ? &*later : nullptr);
      if (report.converged()) return accept(end_s, std::move(next), later ? *later : model_);
      stepper->forget_factor();
    }
    if (halvings == most_halvings)
      throw std::runtime_error(
          fmt::format("the step to t = {:g} s, repeated for a gradient, failed: {}", end_s, report.reason()));
    go_to(0.5 * (now_.time_s + end_s), is_first_order, halvings + 1);
    go_to(end_s, false, halvings + 1);
  }
  TapedRun run() && { return std::move(run_); }

 private:
  void accept(double end_s, State next, const Model& model) {
    next.time_s = end_s;
    if (const auto failure = advance_signals(model, now_, next)) throw std::runtime_error(failure->problem);
    run_.rates.push_back(rates_of(now_, next));
    run_.states.push_back(TapedState::of(next));
    now_ = std::move(next);
  }

  const Model& model_;
  std::vector<std::unique_ptr<NewtonStepper>> steppers_;
  State now_;
  TapedRun run_;
};

}  // namespace

TapedRun replayed(const Model& model, const TapedRun& like, const RunMethod& method) {
  Replay replay(model, method);
  for (std::size_t n = 0; n < like.steps(); ++n)
    replay.go_to(like.states[n + 1].time_s, like.rates[n].ahead == 0);  // after a jump, or of too long a step
  return std::move(replay).run();
}

}  // namespace plica
