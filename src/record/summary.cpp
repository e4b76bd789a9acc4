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
#include "core/words.hpp"
#include "measure/cells.hpp"
#include "mechanics/energy.hpp"
#include "record/results.hpp"
#include "scenario/check_tissue.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/print.hpp"
#include "scenario/words.hpp"
#include "simulation/run_warnings.hpp"

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

// Without "-0", which rows of a resumed run do not have either.
Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value + 0.0) : Json(nullptr); }

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
Json stopped_by(const Scenario& scenario, const Simulation& simulation) {
  std::vector<std::string> names;
  if (simulation.criterion_met()) names = simulation.measures().criteria_met;
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

constexpr double least_change = 0.005;  // smallest reported change of a ratio

// Last line of a run; values that the run lacks are left out.
class SummaryLine {
 public:
  explicit SummaryLine(const Json& summary) : summary_(summary) {}

  void value(const char* words, const char* key, const char* unit = "", const char* after = "") {
    if (const auto number = number_of(summary_, key)) text(fmt::format("{} {:.2f}{}{}", words, *number, unit, after));
  }
  void change(const char* words, const char* key) {
    if (std::abs(number_of(summary_, key).value_or(1) - 1) > least_change) value(words, key);
  }
  void text(std::string part) { parts_.push_back(std::move(part)); }
  [[nodiscard]] std::string joined() const { return fmt::format("{}", fmt::join(parts_, ", ")); }

 private:
  const Json& summary_;
  std::vector<std::string> parts_;
};

void add_furrow(const Json& summary, SummaryLine& line) {
  line.value("furrow depth", "furrow_depth_um", " um");
  line.value("apical area ratio", "vml_apical_area_ratio", "", " (midline centre)");
  line.value("peak speed ratio", "peak_speed_ratio", "", " (end/centre)");
  const auto closed = number_of(summary, "lips_closed"), closed_s = number_of(summary, "lips_closed_time_s");
  if (closed && closed_s)
    line.text(fmt::format("lips {} at {}", *closed == 1 ? "closed" : "open again, closed", moment(*closed_s)));
  else if (closed)
    line.text("lips open");
}

}  // namespace

Json make_summary(const Scenario& scenario, const Simulation& simulation, const std::vector<Observation>& rows,
                  const WallTimes& wall) {
  const Tissue& tissue = simulation.model().tissue;
  const std::vector<Monitor>& monitors = simulation.observer().monitors();
  Json summary;
  summary["scenario"] = scenario.name;
  summary["title"] = scenario.title;
  // A run under way is recorded only when interrupted.
  summary["status"] = simulation.status() == RunStatus::under_way ? "interrupted" : word(simulation.status());
  summary["stopped_by"] = stopped_by(scenario, simulation);
  summary["failure"] = simulation.failure().empty() ? Json(nullptr) : Json(simulation.failure());
  summary["warnings"] = warnings_of(scenario, simulation);
  summary["failed_cell"] = simulation.failed_cell() ? Json(*simulation.failed_cell()) : Json(nullptr);
  summary["time_s"] = rows.back().time_s();
  summary["equilibrium_time_s"] = number(simulation.equilibrium_time_s());
  summary["cells"] = tissue.cells.size();
  summary["nodes"] = tissue.free_node_count();
  summary["elements"] = tissue.elements.size();
  summary["divisions"] = simulation.divisions();
  summary["steps"] = simulation.steps();
  summary["wall_s"] = wall.total_s;
  summary["wall_solver_s"] = wall.solver_s;
  summary["peak_memory_MB"] = peak_memory_MB();
  for (const Column* column : simulation.observer().columns())
    if (column->in_summary != InSummary::nothing)
      summary[column->name] = in_json(*column, summary_value(*column, rows));
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

std::string outcome_text(const Scenario& scenario, const Tissue& tissue, const Json& summary) {
  SummaryLine line(summary);
  if (have_furrow(axes_of(scenario.embryo)) && number_of(summary, "vml_apical_area_ratio")) {
    add_furrow(summary, line);
  } else {
    line.value("fold depth", "furrow_depth_um", " um");
    line.value("largest displacement", "max_displacement_um", " um");
    line.value("smallest apical area ratio", "min_apical_area_ratio");
    line.change("lumen volume ratio", "lumen_volume_ratio");
  }
  if (const auto divisions = number_of(summary, "divisions").value_or(0); divisions > 0)
    line.text(fmt::format("{} cells after {} division{}", tissue.cells.size(), divisions, divisions == 1 ? "" : "s"));
  line.change("tissue volume ratio", "tissue_volume_ratio");
  return line.joined();
}

std::string crossing_text(const Scenario& scenario, const Json& summary) {
  const auto time_s = number_of(summary, "self_intersections_time_s");
  if (!time_s) return "";
  return fmt::format("self-intersects since {} ({} pairs of faces at most); later results are unphysical{}",
                     moment(*time_s), summary.at("self_intersections").get<int>(), crossing_remedy(scenario));
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
