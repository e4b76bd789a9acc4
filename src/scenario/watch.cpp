#include "scenario/watch.hpp"

#include <fmt/format.h>

#include <iterator>

#include "core/errors.hpp"
#include "scenario/regions.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

Over over_named(const std::string& name) {
  return name == "max"   ? Over::max
         : name == "min" ? Over::min
         : name == "sum" ? Over::sum
         : name == "rms" ? Over::rms
                         : Over::mean;
}

void open_reference(const MonitorInput& input, Monitor& monitor) {
  const QuantityInfo::Reference kind = info_of(monitor.quantity).reference;
  if (kind == QuantityInfo::Reference::run) {
    monitor.reference_run = std::make_shared<ReferenceRun>(input.reference);
    if (input.reference_at == "end") monitor.reference_frame = monitor.reference_run->last_frame();
  }
  if (kind == QuantityInfo::Reference::surface)
    monitor.reference_surface = std::make_shared<SurfaceDistance>(read_surface(input.reference));
}

Monitor make_monitor(const std::string& name, const MonitorInput& input, const Scenario& scenario) {
  Monitor monitor;
  monitor.name = name;
  monitor.quantity = quantity_named(input.quantity)->quantity;
  monitor.region = input.region;
  monitor.from = input.from;
  if (!input.face.empty()) monitor.face = input.face == "apical" ? Monitor::Face::apical : Monitor::Face::basal;
  if (!input.axis.empty()) monitor.axis = input.axis[0] - 'x';
  monitor.over = over_named(input.over);
  monitor.poisson_ratio = scenario.elasticity.poisson_ratio;
  open_reference(input, monitor);
  return monitor;
}

bool reads_something(const Monitor& monitor, const Tissue& tissue) {
  const QuantityInfo::Of of = info_of(monitor.quantity).of;
  return of == QuantityInfo::Of::node ? !monitored_nodes(monitor, tissue).empty()
                                      : !monitored_cells(monitor, tissue).empty();
}

StopRule make_stop_rule(const Scenario& scenario) {
  StopRule rule;
  rule.all = scenario.stop.combine == "all";
  rule.needs_rest = scenario.stop.at_equilibrium;
  for (const auto& [name, input] : scenario.criteria) {
    Criterion criterion;
    criterion.name = name;
    const auto monitor = scenario.monitors.find(input.monitor);
    criterion.monitor = static_cast<std::size_t>(std::distance(scenario.monitors.begin(), monitor));
    criterion.above = input.above;
    criterion.below = input.below;
    if (!input.over.empty()) criterion.over = input.over == "any" ? Criterion::Over::any : Criterion::Over::all;
    rule.criteria.push_back(std::move(criterion));
  }
  return rule;
}

}  // namespace

Watch make_watch(const Scenario& scenario, const Tissue& tissue) {
  Watch watch;
  std::vector<Diagnostic> errors;
  for (const auto& [name, input] : scenario.monitors) {
    const std::string path = "monitor." + name;
    const auto refuse_reference = [&](const std::exception& error) {
      errors.push_back(diagnostic_at(scenario, path + ".reference", error.what(), "name another"));
    };
    try {
      watch.monitors.push_back(make_monitor(name, input, scenario));
      if (!reads_something(watch.monitors.back(), tissue))
        errors.push_back(diagnostic_at(scenario, path + ".face",
                                       fmt::format("no cell of region \"{}\" has that side", input.region),
                                       "choose another region or face"));
    } catch (const FileError& error) {
      refuse_reference(error);
    } catch (const MeshError& error) {
      refuse_reference(error);
    }
  }
  if (!errors.empty()) throw ScenarioError(std::move(errors));
  watch.stop = make_stop_rule(scenario);
  return watch;
}

}  // namespace plica
