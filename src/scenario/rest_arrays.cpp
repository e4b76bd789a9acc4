#include "scenario/rest_arrays.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scenario/acting.hpp"

namespace plica {
namespace {

bool is_possible(const ProfileInput& profile, const Tissue& tissue) {
  return profile.shape != "array" || tissue.cell_arrays.contains(profile.array);
}

bool is_finite(const std::vector<double>& values) {
  return std::ranges::all_of(values, [](double value) { return std::isfinite(value); });
}

void add(const std::string& name, const std::vector<double>& values, NamedArrays& arrays) {
  if (is_finite(values)) arrays.emplace_back(name, values);
}

template <class Inputs>
void add_patterns(const std::string& tables, const Inputs& inputs, const Tissue& tissue, NamedArrays& arrays) {
  for (const auto& [name, input] : inputs) {
    if (!is_possible(input.profile, tissue)) continue;
    const std::string of = fmt::format("_{}.{}", tables, name);
    const CellPattern pattern = make_pattern(input, tissue);
    add("strength" + of, pattern.strengths, arrays);
    if (std::ranges::any_of(pattern.delays_s, [](double delay) { return delay > 0; }))
      add("delay_s" + of, pattern.delays_s, arrays);
    if (!pattern.pulse_phases.empty()) add("pulse_phase" + of, pattern.pulse_phases, arrays);
  }
}

void add_materials(const Scenario& scenario, const Tissue& tissue, NamedArrays& arrays) {
  const ElasticityInput& common = scenario.elasticity;
  std::vector<ElasticMaterial> materials(tissue.elements.size(), {1, common.poisson_ratio, 0});
  for (const auto& [name, input] : scenario.region_elasticities)
    if (is_possible(input.profile, tissue)) put_material(input, common, make_pattern(input, tissue), tissue, materials);
  std::vector<double> moduli, ratios;
  for (const auto& [factor, poisson_ratio, relaxation_s] : materials) {
    moduli.push_back(factor * common.young_modulus_Pa);
    ratios.push_back(poisson_ratio);
  }
  const auto add_when_uneven = [&](const std::string& name, const std::vector<double>& values) {
    if (std::ranges::any_of(values, [&](double value) { return value != values.front(); })) add(name, values, arrays);
  };
  add_when_uneven("young_modulus_Pa", moduli);
  add_when_uneven("poisson_ratio", ratios);
}

}  // namespace

RestArrays rest_arrays(const Scenario& scenario, const Tissue& tissue) {
  RestArrays arrays;
  NamedArrays patterns;
  add_patterns("contraction", scenario.contractions, tissue, patterns);
  add_patterns("cortex", scenario.cortices, tissue, patterns);
  add_patterns("pressure", scenario.pressures, tissue, patterns);
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
