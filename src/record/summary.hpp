// Content of summary.json, and the check against [expect].
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure/observation.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"

namespace plica {

struct WallTimes {
  double total_s = 0;
  double solver_s = 0;
};

/// Make the summary with all documented keys; null for events that never happened. `rows`: of the whole run, the
/// reference state first. Last values of monitors have the names of their columns.
nlohmann::ordered_json make_summary(const Scenario& scenario, const Simulation& simulation,
                                    const std::vector<Observation>& rows, const WallTimes& wall);

/// Model name of this machine's processor.
std::string processor_name();

/// Lines for the values of [expect] that the summary misses; empty if all are met.
std::vector<std::string> missed_expectations(const Scenario& scenario, const nlohmann::ordered_json& summary);

}  // namespace plica
