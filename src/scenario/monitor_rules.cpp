// The rules between the keys of [monitor.NAME] and [stop.NAME].
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

/// Keys that the quantity needs, or that mean nothing to it.
void check_keys(const std::string& path, const Info& info, Input& input) {
  const auto given = [&](const std::string& key) { return input.place(path + key) != nullptr; };
  const auto refuse = [&](const std::string& key, const std::string& remedy) {
    if (given(key) && input.sound(path + key))
      input.report(path + key, fmt::format("has no meaning for quantity \"{}\"", info.name), remedy);
  };
  const auto require = [&](const std::string& key, const std::string& remedy) {
    if (!given(key)) input.report(path + key, "is missing", remedy);
  };
  if (info.quantity != Quantity::force) refuse(".from", "remove it; only a force comes from somewhere");
  if (info.axis == Info::Axis::must_have) require(".axis", "give \"x\", \"y\" or \"z\"");
  if (info.axis == Info::Axis::none)
    refuse(".axis", info.quantity == Quantity::speed ? "remove it, or monitor velocity" : "remove it");
  if (!info.has_face()) refuse(".face", "remove it");
  if (info.of == Info::Of::region) refuse(".over", "remove it: there is one value only");
  if (info.reference == Info::Reference::none) refuse(".reference", "remove it");
  if (info.reference == Info::Reference::run) require(".reference", "name the directory of a run's results");
  if (info.reference == Info::Reference::surface) require(".reference", "name a mesh file");
  if (info.reference != Info::Reference::run) refuse(".reference_at", "remove it");
}

void check_monitor(const std::string& path, const MonitorInput& monitor, const Scenario& scenario, Input& input) {
  const std::string address = path + ".quantity";
  const Info* info = quantity_named(monitor.quantity);
  if (info == nullptr || !input.sound(path) || !input.sound(address)) return;
  check_keys(path, *info, input);
  if (info->quantity == Quantity::kinetic_energy && scenario.dynamics.density_kg_per_m3 == 0 &&
      input.sound("dynamics.density_kg_per_m3"))
    input.report(address, "a body without mass has no kinetic energy",
                 "give a density in [dynamics], or monitor speed");
  if (info->quantity == Quantity::pressure && method_of(scenario.volume) == VolumeMethod::none &&
      input.sound("volume.method"))
    input.report(address, "cells that do not hold their volume have no pressure", "give volume.method = \"coupled\"");
}

void check_criterion(const std::string& name, const CriterionInput& criterion, const Scenario& scenario, Input& input) {
  const std::string path = "stop." + name;
  if (!input.sound(path)) return;
  if (name == "equilibrium")
    input.report(path, "equilibrium is a criterion already",
                 "see equilibrium_speed_um_per_min, or choose another name");
  const bool bounds_read = input.sound(path + ".above") && input.sound(path + ".below");
  if (!criterion.above && !criterion.below && bounds_read) input.report(path, "bounds nothing", "give above or below");
  if (criterion.above && criterion.below && *criterion.above >= *criterion.below)
    input.report(path + ".above",
                 fmt::format("no value lies above {} and below {}", *criterion.above, *criterion.below),
                 "give a lower bound for above, or make two criteria of it");
  if (criterion.monitor.empty() || !input.sound(path + ".monitor") || !input.sound("monitor." + criterion.monitor))
    return;
  const auto monitor = scenario.monitors.find(criterion.monitor);
  if (monitor == scenario.monitors.end())
    return input.report(path + ".monitor", fmt::format("there is no monitor \"{}\"", criterion.monitor),
                        scenario.monitors.empty() ? "give it as [monitor." + criterion.monitor + "]"
                                                  : did_you_mean(criterion.monitor, keys_of(scenario.monitors)));
  const Info* info = quantity_named(monitor->second.quantity);
  if (info != nullptr && info->of == Info::Of::region && !criterion.over.empty())
    input.report(path + ".over", fmt::format("monitor \"{}\" has one value only", criterion.monitor), "remove it");
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
      input.report("expect." + name, "no monitor has that name",
                   columns.empty() ? "give the monitor as [monitor.NAME]" : did_you_mean(name, columns));
}

}  // namespace

void check_monitors(const Scenario& scenario, Input& input) {
  for (const auto& [name, monitor] : scenario.monitors) check_monitor("monitor." + name, monitor, scenario, input);
  for (const auto& [name, criterion] : scenario.criteria) check_criterion(name, criterion, scenario, input);
  if (input.sound("monitor")) check_expected_monitors(scenario, input);
}

}  // namespace plica
