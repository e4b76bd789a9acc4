// What is wrong with a scenario and only its tissue shows: no face where something acts, nothing enclosed, no node
// held.
#pragma once

#include <vector>

#include "core/errors.hpp"
#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Cells that are inside out at rest.
void check_rest_shape(const Scenario& scenario, const Tissue& tissue, std::vector<Diagnostic>& errors);

/// All else, of a tissue with its regions. Throws ScenarioError with all that it finds.
void check_tissue(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
