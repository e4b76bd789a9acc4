#include "scenario/acting.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/schema.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

StrengthProfile profile_of(const ProfileInput& input, const Tissue& tissue) {
  StrengthProfile profile;
  profile.shape = meaning_of(words::profile_shapes, input.shape, profile.shape);
  profile.axis = meaning_of(words::profile_axes, input.axis, profile.axis);
  profile.in_cells = input.sigma_cells || input.full_cells || !input.at_cells.empty();
  profile.centre = input.centre_deg.value_or(0);
  const std::optional<double> full = profile.axis == PatternAxis::angle ? input.full_deg : input.full_cells;
  profile.half_width = full ? 0.5 * *full : input.half_width_deg.value_or(input.half_width_um.value_or(1));
  profile.sigma = input.sigma_cells.value_or(input.sigma_deg.value_or(input.sigma_um.value_or(1)));
  profile.fade = input.fade_cells.value_or(input.fade_deg.value_or(0));
  for (const auto* places : {&input.at_um, &input.at_cells, &input.at_deg})
    if (!places->empty()) profile.places = *places;
  profile.values = input.factor;
  if (profile.shape == StrengthProfile::Shape::array) profile.array = tissue.cell_arrays.at(input.array);
  profile.array_0 = input.from.value_or(0);
  profile.array_1 = input.to.value_or(1);
  return profile;
}

bool is_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

void add(const std::string& name, const std::vector<double>& values, NamedArrays& arrays) {
  if (is_finite(values)) arrays.emplace_back(name, values);
}

void add_pattern(const Acting& acting, const Tissue& tissue, NamedArrays& arrays) {
  if (!has_array_of(acting.input.profile, tissue)) return;
  const CellPattern pattern = make_pattern(acting.input, tissue);
  add("strength_" + acting.table, pattern.strengths, arrays);
  if (std::ranges::any_of(pattern.delays_s, [](double delay) { return delay > 0; }))
    add("delay_s_" + acting.table, pattern.delays_s, arrays);
  if (!pattern.pulse_phases.empty()) add("pulse_phase_" + acting.table, pattern.pulse_phases, arrays);
}

void add_materials(const Scenario& scenario, const Tissue& tissue, NamedArrays& arrays) {
  std::vector<double> moduli, ratios;
  for (const ElasticMaterial& material : elastic_materials(scenario, {tissue, Mirror()}, tissue)) {
    moduli.push_back(material.factor * scenario.elasticity.young_modulus_Pa);
    ratios.push_back(material.poisson_ratio);
  }
  const auto add_when_uneven = [&](const std::string& name, const std::vector<double>& values) {
    if (std::ranges::any_of(values, [&](double value) { return value != values.front(); })) add(name, values, arrays);
  };
  add_when_uneven("young_modulus_Pa", moduli);
  add_when_uneven("poisson_ratio", ratios);
}

}  // namespace

std::vector<Acting> acting_tables(const Scenario& scenario) {
  std::vector<Acting> all;
  for (const ScenarioTable& table : scenario_tables())
    if (table.acting) table.acting(scenario, all);
  return all;
}

bool has_array_of(const ProfileInput& profile, const Tissue& tissue) {
  return profile.shape != "array" || tissue.cell_arrays.contains(profile.array);
}

CellPattern make_pattern(const ActingInput& input, const Tissue& tissue) {
  PatternRule pattern;
  pattern.profile = profile_of(input.profile, tissue);
  pattern.middle = input.profile.middle.value_or(1);
  pattern.edge = input.profile.edge.value_or(0);
  if (!input.profile.about.empty()) pattern.about = tissue.regions.at(input.profile.about);
  pattern.taper = {input.profile.full_length_um.value_or(0), input.profile.fade_um.value_or(0)};
  pattern.spread = input.variation.spread;
  pattern.seed = static_cast<std::uint64_t>(input.variation.seed);
  pattern.by_place = meaning_of(words::variation_bys, input.variation.by, false);
  pattern.delay.speed = input.delay.speed_um_per_s.value_or(0);
  pattern.delay.axis = meaning_of(words::delay_axes, input.delay.axis, pattern.delay.axis);
  pattern.delay.from = meaning_of(words::delay_starts, input.delay.from, pattern.delay.from);
  pattern.pulse = {input.pulse.period_s.value_or(0), input.pulse.amplitude,
                   meaning_of(words::pulse_phases, input.pulse.phase, false), input.pulse.spread,
                   static_cast<std::uint64_t>(input.pulse.seed)};
  return cell_pattern(tissue, tissue.regions.at(input.region), pattern);
}

CellPattern make_pattern(const ActingInput& input, const Origin& origin, std::vector<Ablation> ablations) {
  CellPattern of_whole = make_pattern(input, origin.whole);
  of_whole.ablations = std::move(ablations);
  if (!origin.mirror.is_used()) return of_whole;
  TissueChange side;
  side.origin = origin.mirror.origins;
  return of_whole.after_change(side);
}

bool takes_from(const AblationInput& ablation, const std::string& table, const std::string& faces) {
  const auto names = [](const std::vector<std::string>& list, const std::string& name) {
    return std::ranges::find(list, name) != list.end();
  };
  return names(ablation.faces, faces) && (ablation.only.empty() || names(ablation.only, table));
}

CellPattern make_ablated_pattern(const Scenario& scenario, const std::string& table, const ActingInput& input,
                                 const Origin& origin) {
  std::vector<Ablation> ablations;
  for (const auto& [name, ablation] : scenario.ablations)
    if (takes_from(ablation, table, input.faces)) {
      ablations.emplace_back(origin.whole.regions.at(ablation.region), ablation.remaining, *ablation.at_s,
                             ablation.until_s, ablation.recovery_s);
      ablations.back().height_percent = ablation.height_percent;
    }
  return make_pattern(input, origin, std::move(ablations));
}

RestArrays rest_arrays(const Scenario& scenario, const Tissue& tissue) {
  RestArrays arrays;
  NamedArrays patterns;
  for (const Acting& acting : acting_tables(scenario))
    if (!acting.faces_key.empty()) add_pattern(acting, tissue, patterns);
  // A mesh written by plica already has these arrays; new values replace them.
  const auto is_replaced = [&](const std::string& name) {
    return name == "cell_id" || name.starts_with("region_") ||
           std::ranges::any_of(patterns, [&](const auto& pattern) { return pattern.first == name; });
  };
  for (const auto& [name, values] : tissue.cell_arrays)
    if (!is_replaced(name)) add(name, values, arrays.cells);
  arrays.cells.insert(arrays.cells.end(), patterns.begin(), patterns.end());
  add_materials(scenario, tissue, arrays.elements);
  return arrays;
}

}  // namespace plica
