// Warning about the energy that time steps of a run lost or added.
#pragma once

#include <string>

#include "simulation/simulation.hpp"

namespace plica {

/// Text with the size of the energy imbalance of a finished run and a remedy. Empty up to 1 % of the energy that
/// flowed; for failed runs, and those that end after a few steps, where the first ones weigh most; and with projected
/// volumes, whose projections do work that is not counted.
std::string energy_warning(const Simulation& simulation);

}  // namespace plica
