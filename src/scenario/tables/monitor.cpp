// [monitor.NAME], [stop], [stop.NAME] and [expect]: probes, and what depends on their values.
#include "measure/monitor.hpp"

#include <algorithm>

#include "scenario/suggest.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_monitor {

std::vector<std::string_view> quantity_names() {
  std::vector<std::string_view> names;
  for (const Quantity& info : quantities()) names.push_back(info.name);
  return names;
}

/// Checks keys that the quantity requires or does not use.
void check_keys(const std::string& path, const Quantity& info, Input& input) {
  const auto given = [&](const std::string& key) { return input.place(path + key) != nullptr; };
  const auto refuse = [&](const std::string& key, const std::string& remedy) {
    if (given(key) && input.sound(path + key))
      input.report(path + key, fmt::format("is not used with quantity \"{}\"", info.name), remedy);
  };
  const auto require = [&](const std::string& key, const std::string& remedy) {
    if (!given(key)) input.report(path + key, "is missing", remedy);
  };
  if (info.name != "force") refuse(".from", "remove from, which applies to forces only");
  if (info.axis == Quantity::Axis::must_have) require(".axis", "set axis to \"x\", \"y\" or \"z\"");
  if (info.axis == Quantity::Axis::none)
    refuse(".axis", info.name == "speed" ? "remove axis, or set quantity to \"velocity\"" : "remove axis");
  if (!info.has_face()) refuse(".face", "remove face");
  if (info.of == Quantity::Of::region) refuse(".over", "remove over, since the quantity has a single value");
  if (info.reference == Quantity::Reference::none) refuse(".reference", "remove reference");
  if (info.reference == Quantity::Reference::run)
    require(".reference", "set reference to the results directory of a run");
  if (info.reference == Quantity::Reference::surface) require(".reference", "set reference to a mesh file");
  if (info.reference != Quantity::Reference::run) refuse(".reference_at", "remove reference_at");
}

void check_monitor(const std::string& path, MonitorInput& monitor, const Scenario& scenario, Input& input) {
  const std::string address = path + ".quantity";
  const Quantity* info = quantity_named(monitor.quantity);
  if (info == nullptr || !input.sound(path) || !input.sound(address)) return;
  check_keys(path, *info, input);
  if (monitor.quantity == "kinetic_energy" && scenario.dynamics.density_kg_per_m3 == 0 &&
      input.sound("dynamics.density_kg_per_m3"))
    input.report(address, "kinetic energy requires a density above 0",
                 "set dynamics.density_kg_per_m3, or set quantity to \"speed\"");
  if (monitor.quantity == "stress" && model_of(scenario.elasticity) == ElasticModel::shape_memory &&
      input.sound("elasticity.model"))
    input.report(address, "model \"shape-memory\" has no stress", "set elasticity.model to \"corotational\"");
  if (monitor.quantity == "pressure" && method_of(scenario.volume) == VolumeMethod::none &&
      input.sound("volume.method"))
    input.report(address, "cell pressure requires conserved cell volumes", "set volume.method to \"coupled\"");
}

void check_criterion(const std::string& path, CriterionInput& criterion, const Scenario& scenario, Input& input) {
  if (!input.sound(path)) return;
  if (path == "stop.equilibrium")
    input.report(path, "\"equilibrium\" is a predefined criterion",
                 "rename the table, or set stop.equilibrium_speed_um_per_min");
  const bool bounds_read = input.sound(path + ".above") && input.sound(path + ".below");
  if (!criterion.above && !criterion.below && bounds_read) input.report(path, "has no bound", "set above or below");
  if (criterion.above && criterion.below && *criterion.above >= *criterion.below)
    input.report(path + ".above",
                 fmt::format("no value lies above {} and below {}", *criterion.above, *criterion.below),
                 "reduce above, or define two criteria");
  if (criterion.monitor.empty() || !input.sound(path + ".monitor") || !input.sound("monitor." + criterion.monitor))
    return;
  const auto monitor = scenario.monitors.find(criterion.monitor);
  if (monitor == scenario.monitors.end())
    return input.report(path + ".monitor", fmt::format("monitor \"{}\" does not exist", criterion.monitor),
                        scenario.monitors.empty() ? "define [monitor." + criterion.monitor + "]"
                                                  : did_you_mean(criterion.monitor, keys_of(scenario.monitors)));
  const Quantity* info = quantity_named(monitor->second.quantity);
  if (info != nullptr && info->of == Quantity::Of::region && !criterion.over.empty())
    input.report(path + ".over", fmt::format("monitor \"{}\" has a single value", criterion.monitor), "remove over");
}

void check_expected_monitors(const Scenario& scenario, Input& input) {
  std::vector<std::string> columns;
  for (const auto& [name, monitor] : scenario.monitors) {
    Monitor known;
    known.name = name;
    known.quantity = quantity_named(monitor.quantity);
    if (known.quantity) columns.push_back(known.column());
  }
  for (const auto& [name, expected] : scenario.expect)
    if (name.find('.') != std::string::npos && std::ranges::find(columns, name) == columns.end() &&
        input.sound("expect." + name))
      input.report("expect." + name, "no monitor has this name",
                   columns.empty() ? "define the monitor as [monitor.NAME]" : did_you_mean(name, columns));
}

void check_expectations(Scenario& scenario, Input& input) {
  for (const auto& [name, expected] : scenario.expect) {
    const std::string path = "expect." + name;
    if (!expected.within && !expected.within_percent && input.sound(path) && input.sound(path + ".within"))
      input.report(path, "has no tolerance", "set within or within_percent");
  }
  if (input.sound("monitor")) check_expected_monitors(scenario, input);
}

}  // namespace of_monitor

ScenarioTable stop_table() {
  ScenarioTable info{"stop", "Early end of a run.", "Run"};
  const auto row = key_rows("stop", &Scenario::stop);
  info.rows = {
      row("equilibrium_speed_um_per_min", &StopInput::equilibrium_speed_um_per_min, positive,
          "Equilibrium: all nodes are slower (µm/min)."),
      row("at_equilibrium", &StopInput::at_equilibrium, anything,
          "Stop at equilibrium; false records the time and continues."),
      row("combine", &StopInput::combine, one_of(words::combinations),
          "Stop at any, or at all, of `[stop.NAME]` and equilibrium."),
  };
  return info;
}

ScenarioTable criterion_table() {
  using namespace of_monitor;
  using K = CriterionInput;
  ScenarioTable info{"stop.*", "Bound on a monitor that ends the run, checked after each step.", "Run"};
  const auto row = key_rows(info, &Scenario::criteria);
  info.rows = {
      row("monitor", &K::monitor, anything, "Bounded monitor.", {.required = true}),
      row("above", &K::above, anything, "Met above this value (unit of the monitor's column)."),
      row("below", &K::below, anything, "Met below this value."),
      row("over", &K::over, one_of(words::criterion_overs),
          "Met if any, or all, of the monitor's nodes or cells pass the bound; default: its single value."),
  };
  check_each(info, &Scenario::criteria, check_criterion);
  return info;
}

ScenarioTable monitor_table() {
  using namespace of_monitor;
  using M = MonitorInput;
  ScenarioTable info{"monitor.*",
                     "Probe: one value per step in `series.csv`, column `NAME.quantity_unit`; the last is in "
                     "`summary.json`. See [output variables](measures.md).",
                     "Output"};
  const auto row = key_rows(info, &Scenario::monitors);
  info.rows = {
      row("quantity", &M::quantity, one_of(quantity_names()), "Recorded quantity.", {.required = true}),
      row("region", &M::region, anything, "Cells measured."),
      row("face", &M::face, one_of(words::surfaces),
          "Nodes of this side only; default all. For areas: the face, default apical."),
      row("axis", &M::axis, one_of(words::axes), "Component; default the norm."),
      row("from", &M::from, anything,
          "For forces: only those exerted by cells of this region, including volume constraints; default the driving "
          "force of the nodes."),
      row("over", &M::over, one_of(words::overs), "Statistic over nodes or cells; default mean."),
      row("reference", &M::reference, anything,
          "Reference, path relative to the scenario file: run directory (deviation, relative_energy_norm) or mesh "
          "(surface_distance).",
          {.is_path = true}),
      row("reference_at", &M::reference_at, one_of(words::reference_times),
          "Frame of the reference run; default the same time."),
      row("at_s", &M::at_s, not_negative,
          "Time of the value in `summary.json` and study tables (s), interpolated; default the last."),
      row("at_min", &M::at_s, not_negative, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),
  };
  info.regions = [](const Scenario& scenario, const TakeRegion& take) {
    for (const auto& [name, it] : scenario.monitors) {
      take("monitor." + name + ".region", it.region);
      take("monitor." + name + ".from", it.from);
    }
  };
  check_each(info, &Scenario::monitors, check_monitor);
  return info;
}

ScenarioTable expect_table() {
  using namespace of_monitor;
  using X = ExpectInput;
  ScenarioTable info{"expect.*",
                     "Checks at the end of the run; a miss gives exit status 1: `NAME = { value = 28.89, "
                     "within_percent = 5 }`, or for a monitor `floor.position_um = { ... }`. Expectations of a "
                     "built-in are not inherited through `base`, nor checked with `--set`.",
                     "Output"};
  const auto row = key_rows(info, &Scenario::expect);
  info.rows = {
      row("value", &X::value, anything, "Expected value.", {.required = true}),
      row("within", &X::within, not_negative, "Tolerance, in the unit of the value."),
      row("within_percent", &X::within_percent, not_negative, "Tolerance in percent of the value.",
          {.instead_of = "within"}),
  };
  info.rules = check_expectations;
  return info;
}

}  // namespace plica
