// Keys and rules of what cells read, a shape or a signal: `follow` of several tables, `trigger` of [cortex.NAME].
#include <fmt/ranges.h>

#include <iterator>

#include "scenario/suggest.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace {

// Checks that the stress of cells is known, if they read it.
bool check_stress(const std::string& part, const ActivationInput& activation, const Scenario& scenario, Input& input) {
  if (activation.measure != "stress_Pa") return true;
  if (model_of(scenario.elasticity) == ElasticModel::shape_memory) {
    if (input.sound("elasticity.model"))
      input.report(part + ".measure", "model \"shape-memory\" has no stress",
                   "set elasticity.model to \"corotational\", or measure to \"apical_stretch\"");
    return false;
  }
  for (const auto& [name, cortex] : scenario.cortices)
    if (cortex.faces != "lateral" && !cortex.direction.axis.empty() &&
        (cortex.stiffness_mN_per_m > 0 || cortex.crowding_mN_per_m > 0)) {
      input.report(part + ".measure", fmt::format("stress_Pa has no passive fibres, such as cortex.{}", name),
                   fmt::format("put stiffness and crowding of cortex.{} into a table without direction", name));
      return false;
    }
  return true;
}

}  // namespace

bool check_reading(const std::string& part, const ActivationInput& reading, bool has_bounds, const Scenario& scenario,
                   Input& input, bool may_be_shape) {
  if (!input.sound(part + ".measure") || !input.sound(part + ".signal")) return false;
  const auto report = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    input.report(part + key, problem, remedy);
    return false;
  };
  if (!reading.is_used() && (has_bounds || reading.of != ActivationInput().of)) {
    if (!may_be_shape) return report(".signal", "is missing", "set signal to the name of a [signal.NAME]");
    return report(
        ".measure", "is missing",
        fmt::format("set measure to one of: {}; or set signal", fmt::join(words_of(words::cell_measures), " | ")));
  }
  if (!reading.measure.empty() && !reading.signal.empty())
    return report(".signal", "conflicts with `measure`, which is also set", "remove one of them");
  if (!check_stress(part, reading, scenario, input)) return false;
  if (reading.signal.empty() || scenario.signals.contains(reading.signal)) return reading.is_used();
  const std::string problem = fmt::format("no signal \"{}\"", reading.signal);
  if (scenario.signals.empty()) return report(".signal", problem, fmt::format("add [signal.{}]", reading.signal));
  return report(".signal", problem, did_you_mean(reading.signal, keys_of(scenario.signals)));
}

bool check_follow(const std::string& table, const FollowInput& follow, const Scenario& scenario, Input& input,
                  bool may_be_shape) {
  const std::string part = table + ".follow";
  if (!input.sound(table) || !input.sound(part)) return false;
  if (!check_reading(part, follow, follow.from || follow.to, scenario, input, may_be_shape)) return false;
  const auto report = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input.sound(part + key)) input.report(part + key, problem, remedy);
  };
  if (!follow.from) report(".from", "is missing", "set `from` to the value at which the factor is 0");
  if (!follow.to) report(".to", "is missing", "set `to` to the value at which the factor is 1");
  if (follow.from && follow.from == follow.to) report(".to", "equals `from`", "set `to` to a different value");
  return true;
}

ShapeActivationRule make_reading(const ActivationInput& input, const Scenario& scenario) {
  ShapeActivationRule rule;
  rule.measure = meaning_of(words::cell_measures, input.measure, rule.measure);
  rule.of_neighbours = meaning_of(words::read_cells, input.of);
  const auto signal = scenario.signals.find(input.signal);
  if (signal != scenario.signals.end() || rule.measure == ShapeMeasure::passive_stress)
    rule.signal = static_cast<std::size_t>(std::distance(scenario.signals.begin(), signal));
  return rule;
}

ShapeActivationRule make_follow(const FollowInput& input, const Scenario& scenario) {
  if (!input.is_used()) return {};
  ShapeActivationRule rule = make_reading(input, scenario);
  rule.kind = ShapeActivationRule::Kind::follows;
  rule.from = reading_unit(rule) * *input.from;
  rule.to = reading_unit(rule) * *input.to;
  return rule;
}

}  // namespace plica
