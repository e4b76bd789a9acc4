// What a run measures and when it stops, from [measure], [monitor.NAME] and [stop.NAME].
#pragma once

#include "measure/observation.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Begins the measure sets, makes monitors in the order of their names, opens their references, and makes the stop
/// criteria. `model`: of the whole tissue. Throws ScenarioError for errors that depend on the tissue or on files.
Watch make_watch(const Scenario& scenario, const Model& model);

}  // namespace plica
