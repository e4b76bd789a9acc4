// Tensions that have no limit under refinement.
#pragma once

#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Return a warning for each table whose tension is constant, whatever the deformation, and ends at full strength
/// inside the tissue: without a profile, at a border of its region. Strains grow there without limit as elements get
/// smaller (docs/decisions/0005-spread-springs.md). Each names a profile that ends at 0.
std::vector<std::string> abrupt_loads(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
