#include "solver/sensitivity/taped_run.hpp"

#include <fmt/format.h>

#include <memory>
#include <stdexcept>
#include <utility>

namespace plica {

TapedState TapedState::of(const State& state) {
  return {state.time_s, state.positions, state.multipliers, state.obstacle_forces, state.on_obstacle, state.internals};
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

TapedRun replayed(const Model& model, const TapedRun& like, const RunMethod& method) {
  // Where contacts change, rounding may stop Newton's method before the first of these.
  std::vector<std::unique_ptr<NewtonStepper>> steppers;
  for (const double force : {1e-12, 1e-10, 1e-8})
    steppers.push_back(std::make_unique<NewtonStepper>(
        model, StepTolerances{.force = force, .constraint = 0.1 * force, .gap_um = 1e-11, .max_iterations = 60},
        method.linear_method, method.order));
  State now = rest_state(model);
  TapedRun run;
  run.states.push_back(TapedState::of(now));
  for (std::size_t n = 0; n < like.steps(); ++n) {
    if (like.rates[n].ahead == 0) now.trend = {};  // a step of first order follows a jump, or is too long
    State next;
    const double end_s = like.states[n + 1].time_s;
    StepReport report;
    for (const auto& stepper : steppers) {
      report = stepper->advance(now, end_s - now.time_s, n == 0, next);
      if (report.converged()) break;
      stepper->forget_factor();
    }
    if (!report.converged())
      throw std::runtime_error(
          fmt::format("the step to t = {:g} s, repeated for a gradient, failed: {}", end_s, report.reason()));
    next.time_s = end_s;
    run.rates.push_back(rates_of(now, next));
    run.states.push_back(TapedState::of(next));
    now = std::move(next);
  }
  return run;
}

}  // namespace plica
