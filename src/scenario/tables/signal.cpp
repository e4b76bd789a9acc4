// [signal.NAME]: numbers per cell that have sources, decay, react and diffuse from cell to cell.
#include <fmt/ranges.h>

#include <algorithm>

#include "mechanics/signals/signals.hpp"
#include "scenario/suggest.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_signal {

using S = SignalInput;

void check_constants(const std::string& table, const S& signal, const std::vector<std::string>& variables,
                     Input& input) {
  const std::vector<std::string> functions = reaction_functions();
  for (const auto& [name, value] : signal.constants) {
    const bool is_taken = std::ranges::count(variables, name) + std::ranges::count(functions, name) > 0;
    if (!is_taken && is_reaction_name(name)) continue;
    input.report(table + ".constants",
                 is_taken ? fmt::format("\"{}\" is the name of a signal, a measure or a function", name)
                          : fmt::format("\"{}\" is not a valid name", name),
                 is_taken ? "rename the constant" : "use letters, digits and \"_\", no digit first");
    return;
  }
}

void check_reaction(const std::string& table, const S& signal, const std::vector<std::string>& signals, Input& input) {
  std::vector<std::string> variables = reaction_variables(signals);
  if (signal.reaction.empty()) {
    if (!signal.constants.empty())
      input.report(table + ".constants", "is not used without `reaction`", "remove it, or set reaction");
    return;
  }
  check_constants(table, signal, variables, input);
  if (!input.sound(table + ".constants")) return;
  try {
    const Reaction reaction(signal.reaction, variables, signal.constants);
    for (const auto& [name, value] : signal.constants) variables.push_back(name);
  } catch (const ReactionError& error) {
    for (const std::vector<std::string>& more : {keys_of(signal.constants), reaction_functions()})
      variables.insert(variables.end(), more.begin(), more.end());
    const auto nearest = nearest_name(error.unknown, variables);
    input.report(table + ".reaction", error.what(),
                 error.unknown.empty() ? "write one expression, such as \"k * u * (1 - u)\""
                 : nearest             ? fmt::format("use \"{}\" (nearest match)", *nearest)
                                       : fmt::format("use signals ({}), measures ({}), or names in constants",
                                                     fmt::join(signals, ", "), fmt::join(shape_measure_names, ", ")));
  }
}

void check_signal(const std::string& table, const S& signal, const std::vector<std::string>& signals, Input& input) {
  const auto sound = [&](const char* key) { return input.sound(table) && input.sound(table + key); };
  if (sound(".source") && sound(".source.region") && sound(".source.per_min") &&
      signal.source.region.empty() != !signal.source.per_min.has_value()) {
    const bool has_region = !signal.source.region.empty();
    input.report(
        table + (has_region ? ".source.per_min" : ".source.region"), "is missing",
        has_region ? "set per_min to what its cells make in a minute" : "set region to the cells that make it");
  }
  if (sound(".initial") && !signal.initial_array.empty() && input.place(table + ".initial") != nullptr)
    input.report(table + ".initial_array", "conflicts with `initial`, which is also set", "remove one of them");
  if (sound(".reaction")) check_reaction(table, signal, signals, input);
}

void check_signals(Scenario& scenario, Input& input) {
  const std::vector<std::string> names = keys_of(scenario.signals), measures = reaction_variables({}),
                                 functions = reaction_functions();
  bool are_names = true;
  for (const std::string& name : names) {
    const std::string table = "signal." + name;
    const bool is_taken = std::ranges::count(measures, name) + std::ranges::count(functions, name) > 0;
    if (is_reaction_name(name) && !is_taken) continue;
    are_names = false;
    input.report(table, is_taken ? "has the name of a measure or a function" : "is not a valid name of a signal",
                 is_taken ? "rename the signal" : "use letters, digits and \"_\", no digit first");
  }
  if (!are_names) return;
  for (const auto& [name, signal] : scenario.signals) check_signal("signal." + name, signal, names, input);
}

void check_arrays(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  for (const auto& [name, signal] : scenario.signals)
    if (!signal.initial_array.empty())
      check_array(scenario, fmt::format("signal.{}.initial_array", name), signal.initial_array, "all", tissue, errors);
}

// Values of the whole tissue on its solved side; an error at `key` unless they are symmetric.
CellArray on_side(CellArray values, const Origin& origin, const Scenario& scenario, const std::string& key) {
  if (!origin.mirror.is_used()) return values;
  for (std::size_t c = 0; c < values.size(); ++c)
    if (const CellId image = origin.mirror.original(CellId(c)); values[c] != values[image.index()])
      throw_at(scenario, key,
               fmt::format("is not symmetric: it is {:.4g} in cell {} and {:.4g} in its mirror image, cell {}",
                           values[c], c, values[image.index()], image.number()),
               "give symmetric values without initial_spread, or remove embryo.mirror");
  TissueChange side;
  side.origin = origin.mirror.origins;
  return inherited(side, values);
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  if (scenario.signals.empty()) return;
  constexpr double per_minute = 1.0 / 60;
  const Tissue& whole = origin.whole;
  std::vector<SignalRule> rules;
  for (const auto& [name, input] : scenario.signals) {
    SignalRule rule;
    rule.name = name;
    rule.reaction = input.reaction;
    rule.constants = input.constants;
    rule.diffusion = input.diffusion_um2_per_min * per_minute;
    rule.decay = input.decay_per_min * per_minute;
    const CellSet& begins = whole.regions.at(input.initial_region);
    CellArray initial, sources(whole.cells.size(), 0.0);
    for (std::size_t c = 0; c < whole.cells.size(); ++c) {
      const double value = input.initial_array.empty() ? input.initial : whole.cell_arrays.at(input.initial_array)[c];
      const auto seed = static_cast<std::uint64_t>(input.seed);
      initial.push_back(begins[c] ? value * chance_factor(input.initial_spread, seed, c) : 0);
      if (input.source.per_min && whole.regions.at(input.source.region)[c])
        sources[c] = *input.source.per_min * per_minute;
    }
    const std::string key = fmt::format("signal.{}.", name);
    rule.initial = on_side(std::move(initial), origin, scenario,
                           key + (input.initial_array.empty() ? "initial" : "initial_array"));
    rule.sources = on_side(std::move(sources), origin, scenario, key + "source");
    rules.push_back(std::move(rule));
  }
  model.signals = Signals(model.tissue, std::move(rules));
}

void list_regions(const Scenario& scenario, const TakeRegion& take) {
  for (const auto& [name, signal] : scenario.signals) {
    take(fmt::format("signal.{}.source.region", name), signal.source.region);
    take(fmt::format("signal.{}.initial_region", name), signal.initial_region);
  }
}

}  // namespace of_signal

ScenarioTable signal_table() {
  using namespace of_signal;
  using Source = SignalSourceInput;
  ScenarioTable info{
      "signal.*", "Signal: a concentration per cell, which is made, decays, reacts and diffuses through lateral faces.",
      "Activity"};
  const auto row = key_rows(info, &Scenario::signals);
  info.rows = {
      row("diffusion_um2_per_min", &S::diffusion_um2_per_min, not_negative,
          "Diffusion coefficient from cell to cell (µm²/min)."),
      row("decay_per_min", &S::decay_per_min, not_negative, "Decay rate (1/min)."),
      row("source.region", &S::source, &Source::region, anything, "Cells that make the signal."),
      row("source.per_min", &S::source, &Source::per_min, not_negative, "Concentration that they make in a minute."),
      row("reaction", &S::reaction, anything,
          "One expression, the rate of change in a minute: signals, constants, `apical_area_ratio`, "
          "`basal_area_ratio`, "
          "`height_ratio`, `apical_stretch`, and functions of muParser."),
      row("constants", &S::constants, anything, "Numbers by name for `reaction`: { k = 1 }."),
      row("initial", &S::initial, anything, "Concentration at t = 0."),
      row("initial_region", &S::initial_region, anything, "Cells that have it; others begin with 0."),
      row("initial_array", &S::initial_array, anything, "Instead of `initial`: cell array with the concentrations."),
      row("initial_spread", &S::initial_spread, not_negative,
          "Relative standard deviation of a random factor on them, log-normal with mean 1."),
      row("seed", &S::seed, anything, "Seed of these factors."),
  };
  info.regions = list_regions;
  info.rules = check_signals;
  info.check = check_arrays;
  info.build = build;
  return info;
}

}  // namespace plica
