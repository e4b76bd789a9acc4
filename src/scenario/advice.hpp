// Warnings and notes about a valid scenario, for `plica check` and the start of a run.
#pragma once

#include <string>
#include <vector>

#include "scenario/setup.hpp"

namespace plica {

/// Returns lines that begin with "warning: " (probably not intended) or "note: " (for information).
std::vector<std::string> advice(const Scenario& scenario, const Model& model);

}  // namespace plica
