// Reasons to doubt the results of a run.
#pragma once

#include <string>
#include <vector>

#include "simulation/simulation.hpp"

namespace plica {

struct RunWarning {
  std::string topic;  // key in summary.json
  std::string text;
};

/// Warnings about a run that has ended without a failure: energy lost in time steps, an equilibrium after the first
/// step, bending of too few elements. Empty before the end. `scenario` is that of the simulation.
std::vector<RunWarning> run_warnings(const Scenario& scenario, const Simulation& simulation);

}  // namespace plica
