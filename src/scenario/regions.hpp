// Resolution of region tables to cell sets.
#pragma once

#include <vector>

#include "core/errors.hpp"
#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Fills `tissue.regions`. Adds errors that depend on the embryo (empty regions, missing arrays). References and cycles
/// have been checked by load_scenario.
void add_regions(const Scenario& scenario, Tissue& tissue, std::vector<Diagnostic>& errors);

/// Makes an error at the place of `key`, or of the nearest enclosing table, in the scenario's file.
Diagnostic diagnostic_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy);

/// Throws ScenarioError with this error alone.
[[noreturn]] void throw_at(const Scenario& scenario, const std::string& key, std::string problem, std::string remedy);

/// Makes the error that the tissue lacks an array which `key` names.
Diagnostic no_array(const Scenario& scenario, const std::string& key, const std::string& array, const Tissue& tissue);

}  // namespace plica
