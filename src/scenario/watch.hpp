// From a scenario's [monitor.NAME] and [stop.NAME] to what is watched during its run.
#pragma once

#include "measure/observation.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Monitors in the order of their names, references opened, and the criteria on them. ScenarioError for what only the
/// tissue or the files show to be wrong.
Watch make_watch(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
