#include "simulation/controls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/clock.hpp"
#include "core/units.hpp"
#include "scenario/acting.hpp"
#include "scenario/words.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

DivisionRule make_division_rule(const DivisionInput& input) {
  DivisionRule rule;
  rule.region = input.region;
  if (input.at_s) {
    rule.trigger = DivisionTrigger::time;
    rule.threshold = *input.at_s;
  } else {
    rule.trigger = meaning_of(words::division_triggers, input.when);
    rule.threshold = *input.threshold;
  }
  rule.plane = meaning_of(words::division_planes, input.plane);
  rule.growth_s = input.growth_s;
  rule.every_s = input.every_s;
  rule.volume_ratio = input.daughter_volume_ratio;
  rule.max_generation = input.max_generation.value_or(input.at_s ? std::numeric_limits<int>::max() : 1);
  return rule;
}

StepScheme make_scheme(const Scenario& scenario) {
  StepScheme scheme;
  scheme.forces = meaning_of(words::schemes, scenario.time.scheme);
  scheme.order = meaning_of(words::integrators, scenario.time.integrator).value_or(TimeOrder::first);
  scheme.linear_method = meaning_of(words::linear_solvers, scenario.time.linear_solver);
  scheme.linear_tolerance = scenario.time.cg_tolerance;
  scheme.most_linear_iterations = scenario.time.cg_max_iterations;
  if (method_of(scenario.volume) == VolumeMethod::projection) {
    scheme.projection = ProjectionRule{meaning_of(words::projection_surfaces, scenario.volume.projection_surface),
                                       meaning_of(words::projection_weights, scenario.volume.projection_weights)};
  }
  return scheme;
}

/// Add the points of pulses: steps must resolve them, and there is no equilibrium while cells pulse.
void take_pulses(const PulseInput& pulse, RunControls& controls) {
  if (!pulse.period_s) return;
  controls.max_step_s = std::min(controls.max_step_s, longest_step_of_pulses_s(pulse));
  controls.first_step_s = std::min(controls.first_step_s, controls.max_step_s);
  controls.program_points_s.push_back(controls.end_s);
}

/// Resolve the fluctuations of walls, likewise.
void take_noise(const WallNoiseInput& noise, RunControls& controls) {
  if (!(noise.spread > 0)) return;
  controls.max_step_s = std::min(controls.max_step_s, *noise.correlation_s / 4);
  controls.first_step_s = std::min(controls.first_step_s, controls.max_step_s);
  controls.program_points_s.push_back(controls.end_s);
}

// First multiple of `period` that exceeds `time` by more than `apart`.
double next_multiple(double time, double period, double apart) {
  return (std::floor((time + apart) / period + 1e-9) + 1) * period;
}

// Required end of an adaptive step: the last of the points that form one instant with the next one.
double next_stop(const RunControls& controls, double time_s, double latest_s) {
  std::vector<double> points = {latest_s};
  if (controls.frame_every_s > 0) points.push_back(next_multiple(time_s, controls.frame_every_s, instant_s));
  for (const double point : controls.program_points_s)
    if (!has_come(point, time_s)) points.push_back(point);
  const double first = *std::ranges::min_element(points);
  double last = first;
  for (const double point : points)
    if (has_come(point, first)) last = std::max(last, point);
  return std::min(last, latest_s);
}

}  // namespace

RunControls make_controls(const Scenario& scenario) {
  RunControls controls;
  controls.scheme = make_scheme(scenario);
  controls.fixed_step_s = scenario.time.step_s;
  controls.first_step_s = scenario.time.first_step_s;
  controls.max_step_s = scenario.time.max_step_s;
  controls.position_tolerance_um = scenario.time.tolerance_um;
  controls.end_s = scenario.time.end_s;
  controls.equilibrium_speed_um_per_s = scenario.stop.equilibrium_speed_um_per_min * units::um_per_minute;
  // Equilibrium required together with criteria is one of them (make_measure_plan).
  const bool all_at_once = meaning_of(words::combinations, scenario.stop.combine) && !scenario.criteria.empty();
  controls.stop_at_equilibrium = scenario.stop.at_equilibrium && !all_at_once;
  controls.frame_every_s = scenario.output.frame_every_s;
  for (const Acting& acting : acting_tables(scenario)) take_pulses(acting.input.pulse, controls);
  for (const auto& [name, cortex] : scenario.cortices) take_noise(cortex.noise, controls);
  for (const auto& [name, input] : scenario.divisions) {
    controls.divisions.push_back(make_division_rule(input));
    if (input.at_s) controls.program_points_s.push_back(*input.at_s);
  }
  if (const ExchangeInput& input = scenario.exchange; input.below_um)
    controls.exchange = {input.region, *input.below_um, *input.new_length_um, input.again_after_s};
  for (const auto& [name, input] : scenario.extrusions)
    controls.extrusions.push_back({input.region, input.apical_area_below_um2, input.basal_area_below_um2});
  return controls;
}

StepLength::StepLength(const RunControls& controls, double wanted_s, int careful_steps)
    : wanted_s_(controls.fixed_step_s.value_or(wanted_s > 0 ? wanted_s : controls.first_step_s)),
      careful_steps_(careful_steps) {}

double StepLength::propose_end_s(const RunControls& controls, double time_s, double until_s) const {
  const double latest = std::min(controls.end_s, until_s);
  if (const auto& fixed_s = controls.fixed_step_s) {
    // Stay on the grid of the fixed step, also after a halved step.
    double stop = std::min(latest, next_multiple(time_s, *fixed_s, 1e-6 * *fixed_s));
    for (const double jump : controls.program_jumps_s)
      if (!has_come(jump, time_s)) stop = std::min(stop, jump);
    return wanted_s_ < (stop - time_s) * (1 - 1e-9) ? time_s + wanted_s_ : stop;
  }
  const double stop = next_stop(controls, time_s, latest), left = stop - time_s;
  // Equal steps to the next stop instead of long ones and a remainder; up to a quarter longer than wanted if that saves
  // a step, but to second order at most twice the last (possible_order).
  const double stretch = controls.scheme.order == TimeOrder::first ? 1.25 : 1.2;
  const double steps = std::ceil(left / wanted_s_ * (1 - 1e-12));
  if (steps <= 1 || (steps == 2 && left <= std::min(stretch * wanted_s_, controls.max_step_s))) return stop;
  return time_s + (steps <= 3 ? left / steps : wanted_s_);
}

bool StepLength::accept(const RunControls& controls, const State& before, const State& after) {
  const double duration_s = after.trend.step_s;
  if (controls.fixed_step_s) {
    wanted_s_ = *controls.fixed_step_s;
    return true;
  }
  const std::optional<StepError> error = step_error(before, after);
  if (!error) {
    wanted_s_ = duration_s;
    return true;
  }
  const double allowed = controls.position_tolerance_um / std::max(error->um, 1e-300);
  const double factor = 0.9 * (error->order == TimeOrder::first ? std::sqrt(allowed) : std::cbrt(allowed));
  if (factor < 0.6) {
    wanted_s_ = duration_s * std::max(factor, 0.2);
    return false;
  }
  const double most_growth = careful_steps_ > 0 ? 1.15 : 2.0;
  wanted_s_ = std::min(controls.max_step_s, std::max(duration_s * std::clamp(factor, 0.5, most_growth), 1e-9));
  careful_steps_ = std::max(0, careful_steps_ - 1);
  return true;
}

bool StepLength::halve(const RunControls& controls, double failed_s) {
  wanted_s_ = 0.5 * failed_s;
  careful_steps_ = 4;  // what could not be solved lies near, and its error does not tell
  return wanted_s_ > 1e-4 * controls.fixed_step_s.value_or(controls.first_step_s);
}

std::optional<Standstill> standstill(const Pace& pace, const RunControls& controls, const Model& model,
                                     const State& state) {
  constexpr double hard_step = 5, most_left = 10'000;  // Newton iterations
  constexpr double crushed = 0.01;
  const double advance_s = state.time_s - pace.since_s, step_s = advance_s / pace.steps;
  const double per_step = static_cast<double>(pace.iterations) / pace.steps;
  const double left = pace.iterations * (controls.end_s - state.time_s) / advance_s;
  if (per_step < hard_step || left < most_left) return std::nullopt;
  if (controls.fixed_step_s && step_s > 0.5 * *controls.fixed_step_s) return std::nullopt;
  const CornerRatio worst = least_corner_ratio(model.tissue, state.positions);
  if (worst.ratio > crushed) return std::nullopt;
  const int id = model.tissue.cells[worst.cell.index()].lineage.id;
  return Standstill{worst.cell, fmt::format("forces crush cell {} (a corner has {:.1g} of its volume), and {} steps of "
                                            "{:.1g} s on average took {:.0f} Newton iterations each",
                                            id, worst.ratio, pace.steps, step_s, per_step)};
}

}  // namespace plica
