#include "study/quiet_run.hpp"

#include <chrono>
#include <optional>

#include "measure/measure_set.hpp"
#include "record/csv.hpp"
#include "record/summary.hpp"
#include "scenario/suggest.hpp"
#include "study/unfinished_run.hpp"

namespace plica {
namespace {

RunSummary ended(const Scenario& scenario, const Simulation& simulation, std::vector<Observation> rows,
                 const WallTimes& wall) {
  return {make_summary(scenario, simulation, rows, wall), std::move(rows), simulation.state(),
          series_header(simulation.observer()), simulation.observer().columns()};
}

}  // namespace

RunSummary quiet_run(const Scenario& scenario, const QuietRunHooks& hooks) {
  const auto start = std::chrono::steady_clock::now();
  const auto stop = [&] { return hooks.stop_requested && hooks.stop_requested(); };
  Simulation simulation(scenario);
  simulation.stop_when(stop);
  if (hooks.leave_out) simulation.leave_out(hooks.leave_out);
  std::optional<UnfinishedRun> kept;
  if (!hooks.keep_in.empty()) kept.emplace(hooks.keep_in, hooks.keep_every_s, scenario, simulation);
  std::vector<Observation> rows = kept ? kept->begin() : std::vector{simulation.measures()};
  const auto wall_s = [&, earlier_s = kept ? kept->earlier_s() : 0] {
    return earlier_s + std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  };
  while (!stop() && simulation.step()) {
    rows.push_back(simulation.measures());
    if (hooks.on_row) hooks.on_row(rows.back());
    if (kept) kept->step_accepted(rows, wall_s());
  }
  if (kept && simulation.status() != RunStatus::under_way) kept->end();
  return ended(scenario, simulation, std::move(rows), {wall_s(), simulation.computing_s()});
}

RunSummary run_at_rest(const Scenario& scenario) {
  const Simulation simulation(scenario);
  return ended(scenario, simulation, {simulation.measures()}, {});
}

bool is_a_cost(const std::string& name) { return name == "peak_memory_MB" || name.find("wall_s") != std::string::npos; }

std::string result_remedy(const std::string& name, const std::vector<std::string>& known) {
  const std::string of_set = set_remedy(name);
  return of_set.empty() ? did_you_mean(name, known) : of_set;
}

std::vector<std::string> result_names(const nlohmann::ordered_json& summary) {
  std::vector<std::string> names;
  for (const auto& [name, value] : summary.items())
    if ((value.is_number() || value.is_null()) && name != "stopped_by" && !name.starts_with("fail") && !is_a_cost(name))
      names.push_back(name);
  return names;
}

}  // namespace plica
