#include "record/summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <optional>
#include <string_view>

#include "core/version.hpp"
#include "scenario/print.hpp"
#include "scenario/regions.hpp"

namespace plica {
namespace {

using Json = nlohmann::ordered_json;

Json number(std::optional<double> value) { return value && std::isfinite(*value) ? Json(*value) : Json(nullptr); }

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

// FNV-1a, 64 bits: tells scenarios apart, no more.
std::string hash(std::string_view text) {
  std::uint64_t value = 0xcbf29ce484222325;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3;
  return fmt::format("{:016x}", value);
}

const char* word(RunStatus status) {
  switch (status) {
    case RunStatus::equilibrium:
      return "equilibrium";
    case RunStatus::end_time:
      return "end_time";
    case RunStatus::failed:
      return "failed";
    case RunStatus::under_way:
      return "interrupted";
  }
  return "";
}

// What ended the run: the criteria that were met and rest, where they count; null at the end of time or a failure.
Json stopped_by(const Scenario& scenario, const Simulation& simulation, const Observation& last) {
  std::vector<std::string> names = simulation.criterion_met() ? last.criteria_met : std::vector<std::string>{};
  if (simulation.status() == RunStatus::equilibrium && scenario.stop.at_equilibrium) names.emplace_back("equilibrium");
  return names.empty() ? Json(nullptr) : Json(fmt::format("{}", fmt::join(names, ", ")));
}

// The last value that a monitor had.
std::optional<double> last_value(const std::vector<Observation>& rows, std::size_t monitor) {
  std::optional<double> value;
  for (const Observation& row : rows)
    if (row.monitors[monitor]) value = row.monitors[monitor];
  return value;
}

}  // namespace

Json make_summary(const Scenario& scenario, const Simulation& simulation, const std::vector<Observation>& rows,
                  const WallTimes& wall) {
  const Tissue& tissue = simulation.model().tissue;
  const std::vector<Monitor>& monitors = simulation.observer().monitors();
  const Observation& last = rows.back();
  const SpeedHistory history = speed_history(rows);
  double volume_error = 0, penetration = 0, jacobian = 1;
  for (const Observation& row : rows) {
    volume_error = std::max(volume_error, row.max_volume_error);
    penetration = std::max(penetration, row.max_shell_penetration_um);
    jacobian = std::min(jacobian, row.min_scaled_jacobian);
  }
  Json summary;
  summary["scenario"] = scenario.name;
  summary["title"] = scenario.title;
  summary["status"] = word(simulation.status());
  summary["stopped_by"] = stopped_by(scenario, simulation, last);
  summary["failure"] = simulation.failure().empty() ? Json(nullptr) : Json(simulation.failure());
  summary["time_s"] = last.time_s;
  summary["equilibrium_time_s"] = number(simulation.equilibrium_time_s());
  summary["cells"] = tissue.cells.size();
  summary["nodes"] = tissue.free_node_count();
  summary["elements"] = tissue.elements.size();
  summary["divisions"] = simulation.divisions();
  summary["steps"] = simulation.steps();
  summary["wall_s"] = wall.total_s;
  summary["wall_solver_s"] = wall.solver_s;
  summary["furrow_depth_um"] = number(last.furrow.depth_um);
  summary["furrow_depth_below_lips_um"] = number(last.furrow.depth_below_lips_um);
  summary["lip_distance_um"] = number(last.furrow.lip_distance_um);
  summary["highest_points_distance_um"] = number(last.furrow.highest_points_distance_um);
  summary["vml_apical_area_ratio"] = number(last.vml_apical_area_ratio);
  summary["vce_apical_area_ratio"] = number(last.vce_apical_area_ratio);
  summary["vml_displacement_um"] = number(last.vml_displacement_um);
  summary["vce_displacement_um"] = number(last.vce_displacement_um);
  summary["peak_speed_ratio"] = number(history.peak_ratio);
  summary["peak_speed_ratio_time_s"] = number(history.peak_ratio_time_s);
  summary["ends_lead_until_s"] = number(history.ends_lead_until_s);
  summary["vml_displacement_at_equal_speed_um"] = number(history.vml_displacement_at_equal_speed_um);
  summary["vce_displacement_at_equal_speed_um"] = number(history.vce_displacement_at_equal_speed_um);
  summary["max_node_speed_um_per_s"] = number(last.max_node_speed_um_per_s);
  summary["max_volume_error"] = number(volume_error);
  summary["max_shell_penetration_um"] = number(penetration);
  summary["min_scaled_jacobian"] = number(jacobian);
  summary["lumen_volume_ratio"] = number(last.lumen_volume_ratio);
  std::int64_t newton = 0, solves = 0, sweeps = 0, cubics = 0, three_roots = 0;
  for (const Observation& row : rows) {
    newton += row.newton_iterations, solves += row.linear_solves;
    sweeps += row.projection_sweeps, cubics += row.cubics, three_roots += row.cubics_with_three_roots;
  }
  summary["newton_iterations"] = newton;
  summary["linear_iterations"] = solves;
  for (std::size_t m = 0; m < monitors.size(); ++m) summary[monitors[m].column()] = number(last_value(rows, m));
  const bool projects = scenario.volume.method == "projection";
  summary["projection_sweeps"] = projects ? Json(sweeps) : Json(nullptr);
  summary["cubic_solves"] = projects ? Json(cubics) : Json(nullptr);
  summary["cubic_three_real_roots"] = projects ? Json(three_roots) : Json(nullptr);
  summary["provenance"] = {{"version", version()},
                           {"commit", commit()},
                           {"compiler", compiler()},
                           {"cpu", cpu_name()},
                           {"threads", omp_get_max_threads()},
                           {"scenario_hash", hash(resolved_toml(scenario))}};
  return summary;
}

std::vector<std::string> missed_expectations(const Scenario& scenario, const Json& summary) {
  std::vector<std::string> missed;
  for (const auto& [key, expected] : scenario.expect) {
    const double margin =
        expected.within ? *expected.within : std::abs(expected.value) * *expected.within_percent / 100;
    const Json& found = summary.at(key);
    if (found.is_number() && std::abs(found.get<double>() - expected.value) <= margin) continue;
    const std::string value = found.is_number() ? fmt::format("{:.6g}", found.get<double>()) : "no value";
    missed.push_back(diagnostic_at(scenario, "expect." + key, fmt::format("missed: it came to {}", value),
                                   fmt::format("{} within {:.4g} was expected", expected.value, margin))
                         .text());
  }
  return missed;
}

}  // namespace plica
