#include "scenario/validate.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "core/names.hpp"
#include "scenario/suggest.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

/// Replaces "automatic" by the value that fits the scenario. Call on a valid scenario.
void resolve_automatic(Scenario& scenario) {
  const bool may_invert = !is_of_grid(shape_of(scenario.embryo)) || !scenario.divisions.empty();
  if (!scenario.elasticity.corner_barrier_Pa)
    scenario.elasticity.corner_barrier_Pa =
        may_invert && !is_as_in_the_paper(scenario) ? scenario.elasticity.young_modulus_Pa / 10 : 0;
  if (scenario.time.integrator == "automatic")
    scenario.time.integrator = what_bars_second_order(scenario).empty() ? "bdf2" : "backward-euler";
}

void check_required_keys(const ScenarioTable& info, const Scenario& scenario, Input& input) {
  const std::vector<std::string> names = info.named() ? info.names(scenario) : std::vector<std::string>();
  for (const std::string& name : names) {
    const std::string path = fmt::format("{}.{}", info.stem(), name);
    for (const Row& row : info.rows) {
      const std::string address = fmt::format("{}.{}", path, row.key);
      if (!row.options.required || !input.sound(path) || input.place(address) != nullptr) continue;
      // A misspelt table name is a frequent cause.
      std::vector<std::string> others = names;
      std::erase(others, name);
      const std::optional<std::string> meant = nearest_name(name, others);
      input.report(
          address, "is missing",
          row.remedy() +
              (meant ? fmt::format(", or rename the table to {}.{} (nearest match)", info.stem(), *meant) : ""));
    }
  }
}

void check_region(const std::string& address, const std::string& region, const Scenario& scenario, Input& input) {
  if (region.empty() || region == "all" || scenario.regions.contains(region)) return;
  if (!input.sound("region") || !input.sound(address)) return;
  if (!input.sound("region." + region)) return;  // not read; already reported
  std::vector<std::string> names = keys_of(scenario.regions);
  names.insert(names.begin(), "all");
  std::string remedy = did_you_mean(region, names);
  if (input.sound("embryo.shape") && is_from_file(shape_of(scenario.embryo)))
    remedy += fmt::format("; if it is an array of the file, add [region.{0}] with array = \"{0}\"", region);
  input.report(address, fmt::format("region \"{}\" does not exist", region), remedy);
}

}  // namespace

std::string what_bars_second_order(const Scenario& scenario) {
  if (scenario.time.scheme != "newton") return fmt::format("time.scheme = \"{}\"", scenario.time.scheme);
  if (method_of(scenario.volume) == VolumeMethod::projection) return "volume.method = \"projection\"";
  if (scenario.dynamics.density_kg_per_m3 > 0) return "dynamics.density_kg_per_m3 above 0";
  return "";
}

void validate(Scenario& scenario, Input& input) {
  for (const ScenarioTable& table : scenario_tables()) check_required_keys(table, scenario, input);
  for (const ScenarioTable& table : scenario_tables())
    if (table.rules) table.rules(scenario, input);
  const auto check = [&](const std::string& address, const std::string& region) {
    check_region(address, region, scenario, input);
  };
  for (const ScenarioTable& table : scenario_tables())
    if (table.regions) table.regions(scenario, check);
  if (input.diagnostics.empty()) resolve_automatic(scenario);
}

}  // namespace plica
