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

double last_of(const std::vector<double>& times_s) {
  return times_s.empty() ? 0 : *std::max_element(times_s.begin(), times_s.end());
}

std::string failure_text(StepReport report, const Model& model, const State& state, double duration_s) {
  // Users know a cell by its id, which after divisions is not its place.
  if (report.cell) report.cell = CellId(model.tissue.cells[report.cell->index()].lineage.id);
  return fmt::format("{} at t = {:g} s, with steps down to {:g} s", report.reason(), state.time_s, duration_s);
}

// Before the end of its time.
bool is_over(const RunMemory& run, const RunControls& controls) {
  return run.criterion_met || (run.at_equilibrium && controls.stop_at_equilibrium);
}

}  // namespace

bool has_ended(const RunMemory& run, const RunControls& controls) {
  return is_over(run, controls) || has_come(controls.end_s, run.state.time_s);
}

Division repeat(Model& model, const PastDivision& past) {
  State then = rest_state(model);
  then.time_s = past.time_s;
  then.positions = past.positions;
  return divide_cells(model, then, past.planned);
}

RunResult run(Model& model, RunMemory now, RunControls controls, const StepObserver& observer,
              const std::function<bool()>& stop_requested, const DivisionObserver& division_observer) {
  State& state = now.state;
  const auto add_growth_ends = [&](const PastDivision& past) {
    for (const PlannedDivision& one : past.planned) controls.program_points_s.push_back(past.time_s + one.growth_s);
  };
  for (const auto& past : now.past_divisions) add_growth_ends(*past);
  std::unique_ptr<Stepper> stepper;
  const auto renew_stepper = [&] {
    stepper = make_stepper(model, controls.scheme);
    stepper->stop_when(stop_requested);
  };
  renew_stepper();
  if (!now.factor.empty()) {
    grow(model, now.factor.end_time_s);
    stepper->recall(now.factor);
    now.factor = {};
    grow(model, state.time_s);
  }
  StepLength step_length(controls, now.wanted_step_s);
  const auto divide = [&](const std::vector<PlannedDivision>& due) {
    state.divided_until_s = state.time_s;
    if (due.empty()) return;
    now.past_divisions.push_back(
        std::make_shared<const PastDivision>(PastDivision{state.time_s, state.positions, due}));
    const Division division = divide_cells(model, state, due);
    now.divisions += static_cast<int>(due.size());
    now.equilibrium_time_s.reset();  // it counts only after the last division
    add_growth_ends(*now.past_divisions.back());
    renew_stepper();
    step_length.restart();
    if (division_observer) division_observer(division, state);
  };
  const auto memory = [&] {
    RunMemory copy = now;
    copy.wanted_step_s = step_length.wanted_s();
    copy.factor = stepper->memory();
    return copy;
  };
  divide(due_divisions(model, state, controls.divisions));

  RunResult result;
  State next;
  int wasted_iterations = 0, wasted_solves = 0;
  while (!has_ended(now, controls)) {
    const double duration_s = step_length.propose(state.time_s);
    grow(model, state.time_s + duration_s);
    StepReport report = stepper->advance(state, duration_s, now.steps == 0, next);
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
      result.failure = failure_text(report, model, state, duration_s);
      break;
    }
    report.newton_iterations += std::exchange(wasted_iterations, 0);
    report.linear_solves += std::exchange(wasted_solves, 0);
    if (!step_length.accept(state, next)) {
      wasted_iterations = report.newton_iterations;
      wasted_solves = report.linear_solves;
      continue;
    }
    std::swap(state, next);
    ++now.steps;

    const double speed = max_speed(state);
    const std::vector<PlannedDivision> due = due_divisions(model, state, controls.divisions);
    now.at_equilibrium = speed < controls.equilibrium_speed_um_per_s && due.empty() &&
                         has_come(last_of(controls.program_points_s), state.time_s);
    if (now.at_equilibrium && !now.equilibrium_time_s) now.equilibrium_time_s = state.time_s;
    // At a division, the frame shows the daughters.
    const bool frame_is_due = due.empty() && passes_frame(next.time_s, state.time_s, controls.frame_every_s);
    const StepAnswer answer =
        observer({state, next, duration_s, report, speed, frame_is_due, now.at_equilibrium, memory});
    now.criterion_met = answer.criterion_met;
    if (!answer.go_on && !has_ended(now, controls)) {
      result.status = RunStatus::interrupted;
      break;
    }
    divide(due);
  }
  if (is_over(now, controls) && now.at_equilibrium && result.status != RunStatus::interrupted)
    result.status = RunStatus::equilibrium;
  grow(model, state.time_s);
  result.state = std::move(state);
  result.steps = now.steps;
  result.divisions = now.divisions;
  result.criterion_met = now.criterion_met;
  result.equilibrium_time_s = now.equilibrium_time_s;
  return result;
}

}  // namespace plica
