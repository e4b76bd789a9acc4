// Content of summary.json, in words, and the check against [expect].
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure/observation.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct WallTimes {
  double total_s = 0;
  double solver_s = 0;
};

/// Make the summary with all documented keys; null for events that never happened. `rows`: of the whole run, the
/// reference state first. Last values of monitors have the names of their columns.
nlohmann::ordered_json make_summary(const Scenario& scenario, const Simulation& simulation,
                                    const std::vector<Observation>& rows, const WallTimes& wall);

/// One line from the values of a summary: furrow depth and closure with ventral-dorsal axes, else the fold depth of a
/// sheet, the largest displacement and smallest apical area; cells, volume and lumen if they changed.
std::string outcome_text(const Scenario& scenario, const Tissue& tissue, const nlohmann::ordered_json& summary);

/// Since when a run self-intersects, and the remedy; empty if it does not.
std::string crossing_text(const Scenario& scenario, const nlohmann::ordered_json& summary);

/// Model name of this machine's processor.
std::string processor_name();

/// Lines for the values of [expect] that the summary misses; empty if all are met.
std::vector<std::string> missed_expectations(const Scenario& scenario, const nlohmann::ordered_json& summary);

}  // namespace plica
