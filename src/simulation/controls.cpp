#include "simulation/controls.hpp"

#include <algorithm>
#include <limits>

#include "core/units.hpp"
#include "scenario/acting.hpp"
#include "scenario/words.hpp"

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
  // Equilibrium required together with criteria is one of them (make_watch).
  const bool all_at_once = meaning_of(words::combinations, scenario.stop.combine) && !scenario.criteria.empty();
  controls.stop_at_equilibrium = scenario.stop.at_equilibrium && !all_at_once;
  controls.frame_every_s = scenario.output.frame_every_s;
  for (const Acting& acting : acting_tables(scenario)) take_pulses(acting.input.pulse, controls);
  for (const auto& [name, input] : scenario.divisions) {
    controls.divisions.push_back(make_division_rule(input));
    if (input.at_s) controls.program_points_s.push_back(*input.at_s);
  }
  return controls;
}

}  // namespace plica
