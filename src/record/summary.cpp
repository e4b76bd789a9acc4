#include "record/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include "core/clock.hpp"
#include "core/memory.hpp"
#include "core/version.hpp"
#include "measure/cells.hpp"
#include "mechanics/energy.hpp"
#include "record/outcome.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/print.hpp"
#include "scenario/words.hpp"
#include "simulation/run_warnings.hpp"

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(nullptr); }

Json in_json(const Column& column, std::optional<double> value) {
  return column.is_count && value ? Json(static_cast<std::int64_t>(*value)) : number(value);
}

// FNV-1a, 64 bits: distinguishes scenarios; not cryptographic.
std::string hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", value);
}

// Criteria that ended the run, including equilibrium if enabled; null at the end time or after a failure.
Json stopped_by(const Scenario& scenario, const Simulation& simulation, const Observation& last) {
  std::vector<std::string> names = simulation.criterion_met() ? last.criteria_met : std::vector<std::string>{};
  if (simulation.status() == RunStatus::equilibrium && scenario.stop.at_equilibrium) names.emplace_back("equilibrium");
  return names.empty() ? Json(nullptr) : Json(fmt::format("{}", fmt::join(names, ", ")));
}

// Energies of the laws with any contribution.
Json energy_by_law(const Simulation& simulation) {
  const std::vector<std::string> labels = energy_labels(simulation.model());
  Json table = Json::object();
  for (std::size_t l = 0; l < simulation.energies().size(); ++l) {
    const auto& [active, stored, dissipated] = simulation.energies()[l];
    if (active != 0 || stored != 0 || dissipated != 0)
      table[labels[l]] = {{"active", number(active)}, {"stored", number(stored)}, {"dissipated", number(dissipated)}};
  }
  return table;
}

// Reasons to doubt the results, by topic.
Json warnings_of(const Scenario& scenario, const Simulation& simulation) {
  Json texts = Json::object();
  for (const auto& [topic, text] : run_warnings(scenario, simulation)) texts[topic] = text;
  return texts;
}

// Last value of a monitor.
std::optional<double> last_value(const std::vector<Observation>& rows, std::size_t monitor) {
  std::optional<double> value;
  for (const Observation& row : rows)
    if (row.monitors[monitor]) value = row.monitors[monitor];
  return value;
}

// Value at a time, interpolated linearly; empty if a neighbouring step has none.
std::optional<double> value_at(const std::vector<Observation>& rows, std::size_t monitor, double time_s) {
  const auto after = std::ranges::find_if(rows, [&](const Observation& row) { return has_come(time_s, row.time_s()); });
  if (after == rows.end()) return std::nullopt;
  const auto before = after == rows.begin() || is_same_instant(after->time_s(), time_s) ? after : after - 1;
  const std::optional<double> from = before->monitors[monitor], to = after->monitors[monitor];
  if (!from || !to || before == after) return to;
  return *from + (*to - *from) * (time_s - before->time_s()) / (after->time_s() - before->time_s());
}

}  // namespace

Json make_summary(const Scenario& scenario, const Simulation& simulation, const std::vector<Observation>& rows,
                  const WallTimes& wall) {
  const Tissue& tissue = simulation.model().tissue;
  const std::vector<Monitor>& monitors = simulation.observer().monitors();
  const Observation& last = rows.back();
  Json summary;
  summary["scenario"] = scenario.name;
  summary["title"] = scenario.title;
  // A run under way is recorded only when interrupted.
  summary["status"] = simulation.status() == RunStatus::under_way ? "interrupted" : word(simulation.status());
  summary["stopped_by"] = stopped_by(scenario, simulation, last);
  summary["failure"] = simulation.failure().empty() ? Json(nullptr) : Json(simulation.failure());
  summary["warnings"] = warnings_of(scenario, simulation);
  summary["failed_cell"] = simulation.failed_cell() ? Json(*simulation.failed_cell()) : Json(nullptr);
  summary["time_s"] = last.time_s();
  summary["equilibrium_time_s"] = number(simulation.equilibrium_time_s());
  summary["cells"] = tissue.cells.size();
  summary["nodes"] = tissue.free_node_count();
  summary["elements"] = tissue.elements.size();
  summary["divisions"] = simulation.divisions();
  summary["steps"] = simulation.steps();
  summary["wall_s"] = wall.total_s;
  summary["wall_solver_s"] = wall.solver_s;
  summary["peak_memory_MB"] = peak_memory_MB();
  for (const auto& [column, value] : summary_values(simulation.observer().columns(), rows))
    summary[column->name] = in_json(*column, value);
  for (std::size_t m = 0; m < monitors.size(); ++m)
    summary[monitors[m].column()] =
        number(monitors[m].at_s ? value_at(rows, m, *monitors[m].at_s) : last_value(rows, m));
  summary["outcome"] = outcome_text(scenario, tissue, summary);
  summary["energy_by_law_nN_um"] = energy_by_law(simulation);
  summary["tension_by_law_mN_per_m"] = Json::object();  // nN/um is the same
  for (const auto& [law, tension] : mean_tensions(simulation.model(), simulation.state()))
    summary["tension_by_law_mN_per_m"][law] = number(tension);
  summary["provenance"] = {{"version", version()},
                           {"commit", commit()},
                           {"compiler", compiler()},
                           {"cpu", processor_name()},
                           {"threads", omp_get_max_threads()},
                           {"scenario_hash", hash(resolved_toml(scenario))}};
  return summary;
}

std::string processor_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

std::vector<std::string> missed_expectations(const Scenario& scenario, const Json& summary) {
  std::vector<std::string> missed;
  for (const auto& [key, expected] : scenario.expect) {
    const double margin =
        expected.within ? *expected.within : std::abs(expected.value) * *expected.within_percent / 100;
    const Json& found = summary.at(key);
    if (found.is_number() && std::abs(found.get<double>() - expected.value) <= margin) continue;
    const std::string value = found.is_number() ? fmt::format("{:.6g}", found.get<double>()) : "no value";
    missed.push_back(diagnostic_at(scenario, "expect." + key, fmt::format("missed: result {}", value),
                                   fmt::format("expected {} within {:.4g}", expected.value, margin))
                         .text());
  }
  return missed;
}

}  // namespace plica
