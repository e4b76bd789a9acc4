#include "simulation/run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "simulation/step_length.hpp"

namespace plica {
namespace {

double max_speed(const State& state) {
  double fastest = 0;
  for (const Vec3& velocity : state.velocities) fastest = std::max(fastest, velocity.norm());
  return fastest;
}

bool passes_frame(double from_s, double to_s, double every_s) {
  return every_s > 0 && std::floor(to_s / every_s + 1e-9) > std::floor(from_s / every_s + 1e-9);
}

std::string failure_text(const StepReport& report, const State& state, double duration_s) {
  return fmt::format("{} at t = {:g} s, with steps down to {:g} s", report.reason(), state.time_s, duration_s);
}

}  // namespace

RunResult run(const Model& model, State state, const RunControls& controls, const StepObserver& observer,
              const std::function<bool()>& stop_requested) {
  RunResult result;
  const std::unique_ptr<Stepper> stepper = make_stepper(model, controls.scheme);
  stepper->stop_when(stop_requested);
  StepLength step_length(controls);
  State next;
  double program_end_s = 0;
  for (const double point : controls.program_points_s) program_end_s = std::max(program_end_s, point);
  int wasted_iterations = 0, wasted_solves = 0;
  while (state.time_s < controls.end_s * (1 - 1e-12)) {
    const double duration_s = step_length.propose(state.time_s);
    StepReport report = stepper->advance(state, duration_s, result.steps == 0, next);
    if (report.outcome == StepReport::Outcome::interrupted) {
      result.status = RunStatus::interrupted;
      break;
    }
    if (!report.converged()) {
      wasted_iterations += report.newton_iterations;
      wasted_solves += report.linear_solves;
      stepper->forget_factor();
      if (step_length.halve(duration_s)) continue;
      result.status = RunStatus::failed;
      result.failure = failure_text(report, state, duration_s);
      break;
    }
    report.newton_iterations += std::exchange(wasted_iterations, 0);
    report.linear_solves += std::exchange(wasted_solves, 0);
    if (!step_length.accept(state, next, duration_s)) {
      wasted_iterations = report.newton_iterations;
      wasted_solves = report.linear_solves;
      continue;
    }
    std::swap(state, next);
    ++result.steps;

    const double speed = max_speed(state);
    const bool at_equilibrium = speed < controls.equilibrium_speed_um_per_s && state.time_s >= program_end_s;
    if (at_equilibrium && !result.equilibrium_time_s) result.equilibrium_time_s = state.time_s;
    const bool frame_is_due = passes_frame(next.time_s, state.time_s, controls.frame_every_s);
    if (!observer({state, next, duration_s, report, speed, frame_is_due})) {
      result.status = RunStatus::interrupted;
      break;
    }
    if (at_equilibrium && controls.stop_at_equilibrium) {
      result.status = RunStatus::equilibrium;
      break;
    }
  }
  result.state = std::move(state);
  return result;
}

}  // namespace plica
