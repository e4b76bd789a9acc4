#include "scenario/rest_arrays.hpp"

#include <algorithm>
#include <cmath>

#include "scenario/acting.hpp"

namespace plica {
namespace {

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
