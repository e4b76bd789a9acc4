// From a scenario to what is run: the model, and where the furrow is measured.
#pragma once

#include <memory>

#include "measure/furrow.hpp"
#include "mechanics/model.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// The tissue of a scenario with its regions. Throws ScenarioError (an empty region, a mesh that cannot be used) or
/// FileError.
Tissue make_tissue(const Scenario& scenario);

/// The laws of a scenario on its tissue. Throws ScenarioError for what only the tissue shows to be wrong.
std::unique_ptr<Model> make_model(const Scenario& scenario);

/// VML, VCE, midline and lips of the scenario's furrow; none where there is no contraction.
FurrowSites make_furrow_sites(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
