// Warning about the first self-intersection of a tissue.
#pragma once

#include <string>

#include "simulation/simulation.hpp"

namespace plica {

/// Text with time and place of the self-intersection; empty if there is none.
std::string crossing_warning(const Simulation& simulation);

}  // namespace plica
