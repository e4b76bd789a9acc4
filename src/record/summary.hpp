// summary.json: what a run came to, flat; and whether that was expected.
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

/// The keys of the contract; what never happened is null. Rows are those of the whole run, the one at rest first. Each
/// monitor's last value stands under the name of its column.
nlohmann::ordered_json make_summary(const Scenario& scenario, const Simulation& simulation,
                                    const std::vector<Observation>& rows, const WallTimes& wall);

/// The type of this machine's processor, as it calls itself.
std::string processor_name();

/// One line for each of the scenario's [expect] that the summary misses; empty when all are met.
std::vector<std::string> missed_expectations(const Scenario& scenario, const nlohmann::ordered_json& summary);

}  // namespace plica
