#include "simulation/controls.hpp"

#include <limits>

#include "core/units.hpp"

namespace plica {
namespace {

DivisionRule make_division_rule(const DivisionInput& input) {
  DivisionRule rule;
  rule.region = input.region;
  if (input.at_s) {
    rule.trigger = DivisionTrigger::time;
    rule.threshold = *input.at_s;
  } else {
    rule.trigger = input.when == "area_above_um2"     ? DivisionTrigger::apical_area
                   : input.when == "volume_above_um3" ? DivisionTrigger::volume
                                                      : DivisionTrigger::elongation;
    rule.threshold = *input.threshold;
  }
  rule.plane = input.plane == "transverse" ? DivisionPlane::transverse
               : input.plane == "sagittal" ? DivisionPlane::sagittal
                                           : DivisionPlane::longest_axis;
  rule.growth_s = input.growth_s;
  rule.volume_ratio = input.daughter_volume_ratio;
  rule.max_generation = input.max_generation.value_or(input.at_s ? std::numeric_limits<int>::max() : 1);
  return rule;
}

StepScheme make_scheme(const Scenario& scenario) {
  StepScheme scheme;
  if (scenario.time.scheme == "linearly-implicit") scheme.forces = StepScheme::Forces::linearly_implicit;
  if (scenario.time.integrator == "bdf2") scheme.order = TimeOrder::second;
  const std::string& linear = scenario.time.linear_solver;
  scheme.linear_method = linear == "direct"      ? LinearMethod::direct
                         : linear == "cholesky"  ? LinearMethod::cholesky
                         : linear == "multigrid" ? LinearMethod::multigrid
                                                 : LinearMethod::automatic;
  scheme.linear_tolerance = scenario.time.cg_tolerance;
  scheme.most_linear_iterations = scenario.time.cg_max_iterations;
  if (scenario.volume.method == "projection") {
    using Rule = ProjectionRule;
    const std::string& surface = scenario.volume.projection_surface;
    Rule& rule = scheme.projection.emplace();
    rule.surfaces = surface == "cells"    ? Rule::Surfaces::cells
                    : surface == "tissue" ? Rule::Surfaces::tissue
                                          : Rule::Surfaces::embryo;
    rule.weights = scenario.volume.projection_weights == "equal" ? Rule::Weights::equal : Rule::Weights::mobility;
  }
  return scheme;
}

}  // namespace

RunControls make_controls(const Scenario& scenario, const Model& model) {
  RunControls controls;
  controls.scheme = make_scheme(scenario);
  controls.fixed_step_s = scenario.time.step_s;
  controls.first_step_s = scenario.time.first_step_s;
  controls.max_step_s = scenario.time.max_step_s;
  controls.position_tolerance_um = scenario.time.tolerance_um;
  controls.end_s = scenario.time.end_s;
  controls.equilibrium_speed_um_per_s = scenario.stop.equilibrium_speed_um_per_min * units::um_per_minute;
  // Where rest must come together with criteria, it is one of them (make_watch).
  controls.stop_at_equilibrium =
      scenario.stop.at_equilibrium && (scenario.stop.combine == "any" || scenario.criteria.empty());
  controls.frame_every_s = scenario.output.frame_every_s;
  const auto add_points = [&](const std::vector<double>& points) {
    controls.program_points_s.insert(controls.program_points_s.end(), points.begin(), points.end());
  };
  for (const auto& law : model.laws) add_points(law->program_points_s());
  for (const auto& [name, input] : scenario.divisions) {
    controls.divisions.push_back(make_division_rule(input));
    if (input.at_s) controls.program_points_s.push_back(*input.at_s);
  }
  return controls;
}

}  // namespace plica
