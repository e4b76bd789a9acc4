// Warning about the first self-intersection of a tissue.
#pragma once

#include <string>

#include "simulation/simulation.hpp"

namespace plica {

/// Text with time and place of the self-intersection; empty if there is none. `scenario` is that of the simulation.
std::string crossing_warning(const Scenario& scenario, const Simulation& simulation);

/// Remedy that ends a text about self-intersections; empty if the scenario has it already.
std::string crossing_remedy(const Scenario& scenario);

}  // namespace plica
