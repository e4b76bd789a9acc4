// Run of a scenario within the program, without files or progress; used by studies.
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
  nlohmann::ordered_json summary;  // as summary.json; "status" is "failed" if the solver failed
  std::vector<Observation> rows;   // as series.csv, the reference state first
  State state;                     // at the end of the run
  std::vector<std::string> series_columns;
  ColumnList columns;  // without monitors
};

/// Hooks of a run; all optional.
struct QuietRunHooks {
  std::function<bool()> stop_requested = {};            // polled often; once true, the run ends as interrupted
  std::function<void(const Observation&)> on_row = {};  // after every accepted step
  std::function<bool(const Column&)> leave_out = {};    // columns to skip
  std::filesystem::path keep_in = {};                   // directory to save to and resume from
  double keep_every_s = 30;
};

/// Run to equilibrium or the end time; results are bitwise identical with `plica run`. Uses the threads set by
/// omp_set_num_threads. Throws ScenarioError for errors that only the tissue reveals, FileError if it cannot save.
RunSummary quiet_run(const Scenario& scenario, const QuietRunHooks& hooks = {});

/// Summary of a run before its first step: has every key that a run of this scenario will have.
RunSummary run_at_rest(const Scenario& scenario);

/// Whether a number is a computing cost, which differs between runs.
bool is_a_cost(const std::string& name);

/// Remedy for a name that is not among these results: the measure set to add, or the nearest name.
std::string result_remedy(const std::string& name, const std::vector<std::string>& known);

/// Names of the results in a summary: numbers and possible numbers, without costs.
std::vector<std::string> result_names(const nlohmann::ordered_json& summary);

}  // namespace plica
