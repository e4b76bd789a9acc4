// Step control of a run: step lengths, times on which steps end, and end criteria.
#pragma once

#include <optional>
#include <vector>

#include "mechanics/model.hpp"
#include "scenario/scenario.hpp"
#include "simulation/division_rules.hpp"
#include "solver/make_stepper.hpp"

namespace plica {

struct RunControls {
  StepScheme scheme;
  std::optional<double> fixed_step_s;   // empty: adaptive
  double first_step_s = 0.05;           // adaptive
  double max_step_s = 30;               // adaptive
  double position_tolerance_um = 0.05;  // adaptive: largest local error at any node
  double end_s = 3600;
  double equilibrium_speed_um_per_s = 0.2 / 60;
  bool stop_at_equilibrium = true;
  double frame_every_s = 15;             // adaptive steps end on snapshots; 0: none in between
  std::vector<double> program_points_s;  // adaptive steps end on them; equilibrium counts only after the last
  std::vector<double> program_jumps_s;   // jumps of forces: fixed steps end on them, too
  std::vector<DivisionRule> divisions;   // their times are program points
};

/// Controls of a scenario. The simulation adds the points of the activity time courses of its laws.
RunControls make_controls(const Scenario& scenario);

}  // namespace plica
