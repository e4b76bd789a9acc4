#include "scenario/acting.hpp"

#include <algorithm>

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
  Division side;
  side.origin = origin.mirror.origins;
  return of_whole.after_division(side);
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
    if (takes_from(ablation, table, input.faces))
      ablations.emplace_back(origin.whole.regions.at(ablation.region), ablation.remaining, *ablation.at_s,
                             ablation.until_s);
  return make_pattern(input, origin, std::move(ablations));
}

}  // namespace plica
