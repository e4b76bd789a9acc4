// A tissue that passes through itself is a tissue no more: to be said once, with place and time.
#pragma once

#include <string>

#include "simulation/simulation.hpp"

namespace plica {

/// Where it does, in words; empty where it does not.
std::string crossing_warning(const Simulation& simulation);

}  // namespace plica
