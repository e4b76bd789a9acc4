// Rules between keys of [monitor.NAME] and [stop.NAME].
#include <fmt/format.h>

#include <algorithm>

#include "core/names.hpp"
#include "measure/monitor.hpp"
#include "scenario/suggest.hpp"
#include "scenario/validate.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

using Info = QuantityInfo;

/// Checks keys that the quantity requires or does not use.
void check_keys(const std::string& path, const Info& info, Input& input) {
  const auto given = [&](const std::string& key) { return input.place(path + key) != nullptr; };
  const auto refuse = [&](const std::string& key, const std::string& remedy) {
    if (given(key) && input.sound(path + key))
      input.report(path + key, fmt::format("is not used with quantity \"{}\"", info.name), remedy);
  };
  const auto require = [&](const std::string& key, const std::string& remedy) {
    if (!given(key)) input.report(path + key, "is missing", remedy);
  };
  if (info.quantity != Quantity::force) refuse(".from", "remove from, which applies to forces only");
  if (info.axis == Info::Axis::must_have) require(".axis", "set axis to \"x\", \"y\" or \"z\"");
  if (info.axis == Info::Axis::none)
    refuse(".axis", info.quantity == Quantity::speed ? "remove axis, or set quantity to \"velocity\"" : "remove axis");
  if (!info.has_face()) refuse(".face", "remove face");
  if (info.of == Info::Of::region) refuse(".over", "remove over, since the quantity has a single value");
  if (info.reference == Info::Reference::none) refuse(".reference", "remove reference");
  if (info.reference == Info::Reference::run) require(".reference", "set reference to the results directory of a run");
  if (info.reference == Info::Reference::surface) require(".reference", "set reference to a mesh file");
  if (info.reference != Info::Reference::run) refuse(".reference_at", "remove reference_at");
}

void check_monitor(const std::string& path, const MonitorInput& monitor, const Scenario& scenario, Input& input) {
  const std::string address = path + ".quantity";
  const Info* info = quantity_named(monitor.quantity);
  if (info == nullptr || !input.sound(path) || !input.sound(address)) return;
  check_keys(path, *info, input);
  if (info->quantity == Quantity::kinetic_energy && scenario.dynamics.density_kg_per_m3 == 0 &&
      input.sound("dynamics.density_kg_per_m3"))
    input.report(address, "kinetic energy requires a density above 0",
                 "set dynamics.density_kg_per_m3, or set quantity to \"speed\"");
  if (info->quantity == Quantity::pressure && method_of(scenario.volume) == VolumeMethod::none &&
      input.sound("volume.method"))
    input.report(address, "cell pressure requires conserved cell volumes", "set volume.method to \"coupled\"");
}

void check_criterion(const std::string& name, const CriterionInput& criterion, const Scenario& scenario, Input& input) {
  const std::string path = "stop." + name;
  if (!input.sound(path)) return;
  if (name == "equilibrium")
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
  const Info* info = quantity_named(monitor->second.quantity);
  if (info != nullptr && info->of == Info::Of::region && !criterion.over.empty())
    input.report(path + ".over", fmt::format("monitor \"{}\" has a single value", criterion.monitor), "remove over");
}

void check_expected_monitors(const Scenario& scenario, Input& input) {
  std::vector<std::string> columns;
  for (const auto& [name, monitor] : scenario.monitors) {
    if (const Info* info = quantity_named(monitor.quantity)) {
      Monitor known;
      known.name = name;
      known.quantity = info->quantity;
      columns.push_back(known.column());
    }
  }
  for (const auto& [name, expected] : scenario.expect)
    if (name.find('.') != std::string::npos && std::ranges::find(columns, name) == columns.end() &&
        input.sound("expect." + name))
      input.report("expect." + name, "no monitor has this name",
                   columns.empty() ? "define the monitor as [monitor.NAME]" : did_you_mean(name, columns));
}

}  // namespace

void check_monitors(const Scenario& scenario, Input& input) {
  for (const auto& [name, monitor] : scenario.monitors) check_monitor("monitor." + name, monitor, scenario, input);
  for (const auto& [name, criterion] : scenario.criteria) check_criterion(name, criterion, scenario, input);
  if (input.sound("monitor")) check_expected_monitors(scenario, input);
}

}  // namespace plica
