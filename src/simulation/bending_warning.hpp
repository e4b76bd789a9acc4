// Warning about a depth that depends on the number of elements through the height.
#pragma once

#include <string>

#include "simulation/simulation.hpp"

namespace plica {

/// Text with the estimated errors of bending and depth, and a remedy, if the depth may err by 15 % or more at the end
/// of a run; else empty. `scenario` is that of the simulation.
std::string bending_warning(const Scenario& scenario, const Simulation& simulation);

}  // namespace plica
