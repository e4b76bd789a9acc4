// From a scenario's region tables to sets of cells.
#pragma once

#include <vector>

#include "core/errors.hpp"
#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Fills `tissue.regions`. What only the embryo shows (a region with no cell, an array that the mesh lacks) is added to
/// `errors`. References and circles have been checked by load_scenario.
void add_regions(const Scenario& scenario, Tissue& tissue, std::vector<Diagnostic>& errors);

/// The place of `key` (or the nearest table around it) in the scenario's file, as the start of a message.
Diagnostic diagnostic_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy);

}  // namespace plica
