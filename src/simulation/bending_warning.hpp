// Warning about a depth that depends on the number of elements through the height.
#pragma once

#include <string>

#include "simulation/simulation.hpp"

namespace plica {

/// Text with the estimated error of bending and a remedy, if it is 5 % or more at the end of a run; else empty.
/// `scenario` is that of the simulation.
std::string bending_warning(const Scenario& scenario, const Simulation& simulation);

}  // namespace plica
