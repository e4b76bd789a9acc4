// Monitors and stop criteria of a run, from [monitor.NAME] and [stop.NAME].
#pragma once

#include "measure/observation.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Makes monitors in the order of their names, opens their references, and makes the stop criteria. Throws
/// ScenarioError for errors that depend on the tissue or on files.
Watch make_watch(const Scenario& scenario, const Tissue& tissue);

}  // namespace plica
