#include "scenario/acting.hpp"

#include <algorithm>

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

template <class Acting>
PatternRule strength_rule(const Acting& input, const Tissue& tissue) {
  PatternRule pattern;
  pattern.profile = profile_of(input.profile, tissue);
  pattern.middle = input.profile.middle.value_or(1);
  pattern.edge = input.profile.edge.value_or(0);
  if (!input.profile.about.empty()) pattern.about = tissue.regions.at(input.profile.about);
  pattern.taper = {input.profile.full_length_um.value_or(0), input.profile.fade_um.value_or(0)};
  pattern.spread = input.variation.spread;
  pattern.seed = static_cast<std::uint64_t>(input.variation.seed);
  pattern.by_place = meaning_of(words::variation_bys, input.variation.by, false);
  return pattern;
}

template <class Acting>
CellPattern strengths_of(const Acting& input, const Tissue& tissue) {
  return cell_pattern(tissue, tissue.regions.at(input.region), strength_rule(input, tissue));
}

template <class Acting>
CellPattern pattern_of(const Acting& input, const Tissue& tissue) {
  PatternRule pattern = strength_rule(input, tissue);
  pattern.delay.speed = input.delay.speed_um_per_s.value_or(0);
  pattern.delay.axis = meaning_of(words::delay_axes, input.delay.axis, pattern.delay.axis);
  pattern.delay.from = meaning_of(words::delay_starts, input.delay.from, pattern.delay.from);
  pattern.pulse = {input.pulse.period_s.value_or(0), input.pulse.amplitude,
                   meaning_of(words::pulse_phases, input.pulse.phase, false), input.pulse.spread,
                   static_cast<std::uint64_t>(input.pulse.seed)};
  return cell_pattern(tissue, tissue.regions.at(input.region), pattern);
}

Vec3 mean(std::span<const NodeId> nodes, const Vectors& positions) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId node : nodes) sum += positions[node.index()];
  return sum / static_cast<double>(nodes.size());
}

// Height of the element's centre in its cell, reference state: 0 at the basal, 100 at the apical surface.
double height_percent(const Tissue& tissue, std::size_t element) {
  const Cell& cell = tissue.cells[tissue.element_cell[element].index()];
  const Vec3 base = mean(cell.basal_corners(), tissue.rest_positions);
  const Vec3 up = mean(cell.apical_corners(), tissue.rest_positions) - base;
  return 100 * (mean(tissue.elements[element], tissue.rest_positions) - base).dot(up) / up.squaredNorm();
}

}  // namespace

CellPattern make_pattern(const ContractionInput& input, const Tissue& tissue) { return pattern_of(input, tissue); }
CellPattern make_pattern(const CortexInput& input, const Tissue& tissue) { return pattern_of(input, tissue); }
CellPattern make_pattern(const PressureInput& input, const Tissue& tissue) { return strengths_of(input, tissue); }
CellPattern make_pattern(const RegionElasticityInput& input, const Tissue& tissue) {
  return strengths_of(input, tissue);
}

bool takes_from(const AblationInput& ablation, const std::string& table, const std::string& faces) {
  const auto names = [](const std::vector<std::string>& list, const std::string& name) {
    return std::ranges::find(list, name) != list.end();
  };
  return names(ablation.faces, faces) && (ablation.only.empty() || names(ablation.only, table));
}

std::vector<Ablation> make_ablations(const Scenario& scenario, const std::string& table, const std::string& faces,
                                     const Tissue& tissue) {
  std::vector<Ablation> ablations;
  for (const auto& [name, input] : scenario.ablations)
    if (takes_from(input, table, faces))
      ablations.emplace_back(tissue.regions.at(input.region), input.remaining, *input.at_s, input.until_s);
  return ablations;
}

std::vector<bool> held_nodes(const HoldInput& input, const Tissue& tissue) {
  const auto inside = [](const std::optional<Range>& range, double value) {
    // The tolerance includes nodes on a plane given as [a, a] despite rounding.
    return !range || (value >= (*range)[0] - 1e-9 && value <= (*range)[1] + 1e-9);
  };
  const CellSet& cells = tissue.regions.at(input.region);
  std::vector<bool> held(tissue.node_count(), false);
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    if (!cells[tissue.element_cell[e].index()]) continue;
    for (const NodeId node : tissue.elements[e]) {
      const Vec3& x = tissue.rest_positions[node.index()];
      if (inside(input.x_um, x.x()) && inside(input.y_um, x.y()) && inside(input.z_um, x.z()))
        held[node.index()] = true;
    }
  }
  return held;
}

std::vector<bool> elements_of(const RegionElasticityInput& input, const CellSet& cells, const Tissue& tissue) {
  std::vector<bool> result;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    bool is_in = cells[tissue.element_cell[e].index()];
    if (is_in && input.height_percent) {
      const double height = height_percent(tissue, e);
      is_in = height >= (*input.height_percent)[0] && height <= (*input.height_percent)[1];
    }
    result.push_back(is_in);
  }
  return result;
}

void put_material(const RegionElasticityInput& input, const ElasticityInput& common, const CellPattern& pattern,
                  const Tissue& tissue, std::vector<ElasticMaterial>& materials) {
  const std::vector<bool> chosen = elements_of(input, pattern.cells, tissue);
  const double modulus = input.young_modulus_Pa.value_or(common.young_modulus_Pa);
  for (std::size_t e = 0; e < materials.size(); ++e) {
    if (!chosen[e]) continue;
    materials[e].factor = modulus * pattern.strengths[tissue.element_cell[e].index()] / common.young_modulus_Pa;
    if (input.poisson_ratio) materials[e].poisson_ratio = *input.poisson_ratio;
    if (input.relaxation_s) materials[e].relaxation_s = *input.relaxation_s;
  }
}

}  // namespace plica
