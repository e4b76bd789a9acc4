// Reasons to doubt the results of a run. `scenario` is that of the simulation; a text is empty without a reason.
#pragma once

#include <string>
#include <vector>

#include "simulation/simulation.hpp"

namespace plica {

/// Size of the energy imbalance of a finished run and a remedy, above 1 % of the energy that flowed. Empty for failed
/// runs, and those that end after a few steps, where the first ones weigh most; and with projected volumes, whose
/// projections do work that is not counted.
std::string energy_warning(const Simulation& simulation);

/// Estimated errors of bending and depth, and a remedy, if the depth may err by 15 % or more at the end of a run.
std::string bending_warning(const Scenario& scenario, const Simulation& simulation);

/// Time and place of the first self-intersection of the tissue.
std::string crossing_warning(const Scenario& scenario, const Simulation& simulation);

/// Remedy that ends a text about self-intersections; empty if the scenario has it already.
std::string crossing_remedy(const Scenario& scenario);

struct RunWarning {
  std::string topic;  // key in summary.json
  std::string text;
};

/// Warnings about a run that has ended without a failure: energy lost in time steps, an equilibrium after the first
/// step, bending of too few elements. Empty before the end.
std::vector<RunWarning> run_warnings(const Scenario& scenario, const Simulation& simulation);

}  // namespace plica
