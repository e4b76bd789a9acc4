// What is not wrong in a scenario, but worth knowing before it runs.
#pragma once

#include <string>
#include <vector>

#include "scenario/setup.hpp"

namespace plica {

/// Lines that begin with "warning: " (what cannot work as meant) or "note: ".
std::vector<std::string> advice(const Scenario& scenario, const Model& model);

}  // namespace plica
