// A scenario run in the program itself, without files or progress: what the studies over many runs are made of.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "measure/observation.hpp"
#include "scenario/scenario.hpp"

namespace plica {

struct RunSummary {
  nlohmann::ordered_json summary;  // as summary.json; "status" is "failed" where the numerics gave up
  std::vector<Observation> rows;   // as series.csv, the one at rest first
  State state;                     // where the run ended
  std::vector<std::string> series_columns;
};

/// What somebody may want while it runs.
struct QuietRunHooks {
  std::function<bool()> stop_requested = {};            // asked often; once true, the run ends as interrupted
  std::function<void(const Observation&)> on_row = {};  // after every accepted step
  std::function<bool(const Column&)> leave_out = {};    // what is not measured
  std::filesystem::path keep_in = {};                   // where it keeps itself and goes on from (UnfinishedRun)
  double keep_every_s = 30;
};

/// Runs to equilibrium or the end of time, to the same bits as `plica run`. Threads are as set (omp_set_num_threads).
/// Throws ScenarioError for what only the tissue shows to be wrong, FileError where it cannot keep itself.
RunSummary quiet_run(const Scenario& scenario, const QuietRunHooks& hooks = {});

/// The summary of a run that has not begun: every key that one of this scenario will have.
RunSummary run_at_rest(const Scenario& scenario);

/// What the computation has cost, which differs from run to run.
bool is_a_cost(const std::string& name);

/// What of a summary is a result: the names of its numbers, and of what may become one, without what it cost.
std::vector<std::string> result_names(const nlohmann::ordered_json& summary);

}  // namespace plica
