#include "scenario/watch.hpp"

#include <fmt/format.h>

#include <iterator>

#include "core/errors.hpp"
#include "measure/measure_set.hpp"
#include "scenario/embryo_axes.hpp"
#include "scenario/regions.hpp"
#include "scenario/setup.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

void open_reference(const MonitorInput& input, Monitor& monitor) {
  const QuantityInfo::Reference kind = info_of(monitor.quantity).reference;
  if (kind == QuantityInfo::Reference::run) {
    const auto at = meaning_of(words::reference_times, input.reference_at, Monitor::ReferenceAt::same_time);
    monitor.reference_run = std::make_shared<ReferenceRun>(input.reference);
    if (at == Monitor::ReferenceAt::end) monitor.reference_frame = monitor.reference_run->last_frame();
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
  monitor.face = meaning_of(words::monitor_faces, input.face, monitor.face);
  if (!input.axis.empty()) monitor.axis = meaning_of(words::axes, input.axis);
  monitor.over = meaning_of(words::overs, input.over, monitor.over);
  monitor.at_s = input.at_s;
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
  rule.all = meaning_of(words::combinations, scenario.stop.combine);
  rule.needs_rest = scenario.stop.at_equilibrium;
  for (const auto& [name, input] : scenario.criteria) {
    Criterion criterion;
    criterion.name = name;
    const auto monitor = scenario.monitors.find(input.monitor);
    criterion.monitor = static_cast<std::size_t>(std::distance(scenario.monitors.begin(), monitor));
    criterion.above = input.above;
    criterion.below = input.below;
    criterion.over = meaning_of(words::criterion_overs, input.over, criterion.over);
    rule.criteria.push_back(std::move(criterion));
  }
  return rule;
}

void begin_sets(const Scenario& scenario, const Model& model, KeptBySet& kept, std::vector<Diagnostic>& errors) {
  const Subject subject{model, make_furrow_sites(scenario, model.tissue), have_furrow(axes_of(scenario.embryo)),
                        method_of(scenario.volume) == VolumeMethod::projection};
  const auto is_given = [&](std::string_view name) { return std::ranges::count(scenario.measure.sets, name) > 0; };
  for (const MeasureSet& set : measure_sets()) {
    const bool is_usual = is_given("automatic") && (!set.is_usual || set.is_usual(subject));
    if ((is_given(set.name) || is_usual) && !begin(set, subject, kept) && is_given(set.name))
      errors.push_back(diagnostic_at(scenario, "measure.sets",
                                     fmt::format("\"{}\" has nothing to measure without {}", set.name, set.needs),
                                     "remove it, or supply what it needs"));
  }
  for (const Column& column : columns())
    if (scenario.expect.contains(std::string(column.name)) && !column.set.empty() && !kept.contains(column.set))
      errors.push_back(
          diagnostic_at(scenario, fmt::format("expect.{}", column.name), "is not measured", set_remedy(column.name)));
}

}  // namespace

Watch make_watch(const Scenario& scenario, const Model& model) {
  Watch watch;
  std::vector<Diagnostic> errors;
  begin_sets(scenario, model, watch.sets, errors);
  const Tissue& tissue = model.tissue;
  for (const auto& [name, input] : scenario.monitors) {
    const std::string path = "monitor." + name;
    try {
      watch.monitors.push_back(make_monitor(name, input, scenario));
      if (!reads_something(watch.monitors.back(), tissue))
        errors.push_back(diagnostic_at(scenario, path + ".face",
                                       fmt::format("no cell of region \"{}\" has this face", input.region),
                                       "change region or face"));
    } catch (const FileError& error) {
      errors.push_back(diagnostic_at(scenario, path + ".reference", error.what(), "set reference to another file"));
    }
  }
  if (!errors.empty()) throw ScenarioError(std::move(errors));
  watch.stop = make_stop_rule(scenario);
  return watch;
}

}  // namespace plica
