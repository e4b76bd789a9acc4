// [elasticity] and [elasticity.NAME]: the constitutive law of cells, and other values of it in regions and layers.
#include <algorithm>

#include "mechanics/elasticity/corner_barrier.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/elasticity/shape_memory.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_elasticity {

using E = ElasticityInput;
using R = RegionElasticityInput;

void check_elasticity(Scenario& scenario, Input& input) {
  if (!input.sound("elasticity.model")) return;
  ElasticityInput& elasticity = scenario.elasticity;
  const ElasticityInput defaults;
  const auto only = [&](const std::string& model, const std::string& key, auto ElasticityInput::*field) {
    if (elasticity.model != model)
      drop("elasticity." + key, elasticity.*field, defaults.*field, "elasticity.model",
           fmt::format("is not used with model \"{}\"", elasticity.model),
           fmt::format("remove it, or set elasticity.model to \"{}\"", model), input);
  };
  only("shape-memory", "attractor_stiffness_nN_per_um", &ElasticityInput::attractor_stiffness_nN_per_um);
  only("shape-memory", "attractor_preload_nN", &ElasticityInput::attractor_preload_nN);
  only("shape-memory", "attractor_preload_length_um", &ElasticityInput::attractor_preload_length_um);
  only("neo-hookean", "relaxation_s", &ElasticityInput::relaxation_s);
  if (model_of(elasticity) != ElasticModel::neo_hookean) return;
  if (elasticity.poisson_ratio < 0 && input.sound("elasticity.poisson_ratio"))
    input.report("elasticity.poisson_ratio",
                 fmt::format("{} is below 0, the minimum with model \"neo-hookean\"", elasticity.poisson_ratio),
                 "set poisson_ratio to a number >= 0, or model to \"corotational\"");
  if (scenario.dynamics.shear_viscosity_Pa_s > 0 && input.sound("dynamics.shear_viscosity_Pa_s"))
    input.report("dynamics.shear_viscosity_Pa_s", "model \"neo-hookean\" does not support shear viscosity",
                 "set it to 0 and use elasticity.relaxation_min, or set elasticity.model to \"corotational\"");
}

void check_region_elasticity(const std::string& table, R& it, const Scenario& scenario, Input& input) {
  if (!input.sound(table) || !input.sound("elasticity.model")) return;
  const ElasticModel model = model_of(scenario.elasticity);
  const auto sound = [&](const std::string& key) { return input.sound(table + key); };
  if (model == ElasticModel::shape_memory)
    input.report(table, "model \"shape-memory\" does not support regions",
                 "remove the table, or set elasticity.model to \"corotational\" or \"neo-hookean\"");
  else if (!it.young_modulus_Pa && !it.poisson_ratio && !it.relaxation_s && it.profile.shape.empty() &&
           it.variation.spread == 0 && sound(".young_modulus_Pa") && sound(".poisson_ratio") &&
           sound(".relaxation_s") && sound(".profile") && sound(".profile.shape") && sound(".variation.spread"))
    input.report(table, "has no effect", "set young_modulus_Pa, poisson_ratio, relaxation_min, profile or variation");
  else if (it.relaxation_s && model != ElasticModel::neo_hookean)
    input.report(table + ".relaxation_s", fmt::format("is not used with model \"{}\"", scenario.elasticity.model),
                 "remove it, or set elasticity.model to \"neo-hookean\"");
  if (it.poisson_ratio && *it.poisson_ratio < 0 && model == ElasticModel::neo_hookean && sound(".poisson_ratio"))
    input.report(table + ".poisson_ratio",
                 fmt::format("{} is below 0, the minimum with model \"neo-hookean\"", *it.poisson_ratio),
                 "set poisson_ratio to a number >= 0, or model to \"corotational\"");
}

// Elements of a table among those of `cells`; one entry per element.
std::vector<bool> elements_of(const RegionElasticityInput& input, const CellSet& cells, const Tissue& tissue) {
  std::vector<bool> result;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    bool is_in = cells[tissue.element_cell[e].index()];
    if (is_in && input.height_percent) {
      const double height = height_percent(tissue, tissue.element_cell[e], tissue.elements[e]);
      is_in = height >= (*input.height_percent)[0] && height <= (*input.height_percent)[1];
    }
    result.push_back(is_in);
  }
  return result;
}

// Rejects two tables for one element: neither takes precedence.
void check_apart(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  std::vector<const std::string*> owner(tissue.elements.size(), nullptr);
  for (const auto& [name, input] : scenario.region_elasticities) {
    const std::vector<bool> chosen = elements_of(input, tissue.regions.at(input.region), tissue);
    if (std::ranges::find(chosen, true) == chosen.end())
      errors.push_back(
          diagnostic_at(scenario, "elasticity." + name + ".height_percent",
                        "no element of the region has its centre in this part of the height",
                        is_of_grid(shape_of(scenario.embryo))
                            ? "widen height_percent, or increase embryo.elements_per_cell through the height"
                            : "widen height_percent, or increase embryo.layers"));
    for (std::size_t e = 0; e < chosen.size(); ++e) {
      if (!chosen[e]) continue;
      if (owner[e]) {
        const bool has_layers = input.height_percent.has_value();
        errors.push_back(
            diagnostic_at(scenario, "elasticity." + name,
                          fmt::format("overlaps elasticity.{} in {}{}", *owner[e],
                                      has_layers ? "the same layer of " : "", cell_at(tissue, tissue.element_cell[e])),
                          has_layers ? "set height_percent to disjoint ranges, or use disjoint regions"
                                     : "use disjoint regions, for example with `except`"));
        break;
      }
      owner[e] = &name;
    }
  }
}

// Rejects overlaps, and profiles that reduce the modulus of a cell to 0.
void check_regions(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  check_apart(scenario, tissue, errors);
  if (!errors.empty()) return;
  for (const auto& [name, input] : scenario.region_elasticities) {
    const CellPattern pattern = make_pattern(input, tissue);
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      if (pattern.cells[c] && !(pattern.strengths[c] > 1e-6)) {
        errors.push_back(diagnostic_at(scenario, "elasticity." + name + ".profile",
                                       fmt::format("the modulus of {} would be 0", cell_at(tissue, CellId(c))),
                                       "set profile.edge or profile.factor above 0"));
        break;
      }
  }
}

void build_law(const Scenario& scenario, const Origin& origin, Model& model) {
  const ElasticityInput& input = scenario.elasticity;
  const double young_modulus = input.young_modulus_Pa * units::pascal;
  const double viscosity = scenario.dynamics.shear_viscosity_Pa_s * units::pascal_second;
  model.stiffness_scale = young_modulus;
  if (model_of(input) == ElasticModel::shape_memory) {
    const ElasticModuli moduli = ElasticModuli::from_young(young_modulus, input.poisson_ratio);
    const AttractorSprings springs{input.attractor_stiffness_nN_per_um.value_or(0), moduli.shear_modulus,
                                   input.attractor_preload_nN, input.attractor_preload_length_um};
    auto law = std::make_unique<ShapeMemory>(model.tissue, springs, viscosity);
    // Young's modulus equivalent to a given stiffness.
    const double shear = attractor_moduli(model.tissue.element_rest_shape[0], law->stiffness()[0]).mean_shear();
    model.stiffness_scale = 2 * (1 + input.poisson_ratio) * shear;
    model.laws.push_back(std::move(law));
    return;
  }
  const bool is_soft = model_of(input) == ElasticModel::neo_hookean;
  std::vector<ElasticModuli> moduli;
  std::vector<NeoHookeanMaterial> soft;
  std::vector<double> bulk_moduli;
  double largest_factor = 0;
  for (const auto& [factor, poisson_ratio, relaxation_s] : elastic_materials(scenario, origin, model.tissue)) {
    const ElasticModuli unit = ElasticModuli::from_young(young_modulus, poisson_ratio);
    largest_factor = std::max(largest_factor, factor);
    bulk_moduli.push_back(factor * (is_soft ? unit.lame_lambda : unit.bulk_modulus()));
    if (is_soft)
      soft.push_back({factor * unit.shear_modulus, relaxation_s});
    else
      moduli.push_back(factor * unit);
  }
  model.stiffness_scale *= largest_factor;
  if (is_soft)
    model.laws.push_back(std::make_unique<NeoHookean>(model.tissue, std::move(soft)));
  else
    model.laws.push_back(std::make_unique<Corotational>(model.tissue, std::move(moduli), viscosity));
  if (std::ranges::max(bulk_moduli) > 0)
    model.laws.push_back(std::make_unique<Dilatation>(model.tissue, std::move(bulk_moduli), model.volumes.is_held()));
}

void build(const Scenario& scenario, const Origin& origin, Model& model) {
  build_law(scenario, origin, model);
  if (const double barrier_Pa = scenario.elasticity.corner_barrier_Pa.value_or(0); barrier_Pa > 0)
    model.laws.push_back(std::make_unique<CornerBarrier>(model.tissue, barrier_Pa * units::pascal));
}

}  // namespace of_elasticity

std::vector<ElasticMaterial> elastic_materials(const Scenario& scenario, const Origin& origin, const Tissue& tissue) {
  using namespace of_elasticity;
  const ElasticityInput& common = scenario.elasticity;
  std::vector<ElasticMaterial> materials(tissue.elements.size(),
                                         {1, common.poisson_ratio, common.relaxation_s.value_or(0)});
  for (const auto& [name, input] : scenario.region_elasticities) {
    if (!has_array_of(input.profile, origin.whole)) continue;
    const CellPattern pattern = make_pattern(input, origin);
    const std::vector<bool> chosen = elements_of(input, pattern.cells, tissue);
    const double modulus = input.young_modulus_Pa.value_or(common.young_modulus_Pa);
    for (std::size_t e = 0; e < materials.size(); ++e) {
      if (!chosen[e]) continue;
      materials[e].factor = modulus * pattern.strengths[tissue.element_cell[e].index()] / common.young_modulus_Pa;
      if (input.poisson_ratio) materials[e].poisson_ratio = *input.poisson_ratio;
      if (input.relaxation_s) materials[e].relaxation_s = *input.relaxation_s;
    }
  }
  return materials;
}

ScenarioTable elasticity_table() {
  using namespace of_elasticity;
  ScenarioTable info{"elasticity", "Constitutive law of cells.", "Passive mechanics"};
  const auto row = key_rows("elasticity", &Scenario::elasticity);
  info.rows = {
      row("model", &E::model, one_of(words::elastic_models),
          "`corotational`: linear isotropic in a frame that rotates with the cell. `neo-hookean`: for soft cells at "
          "large strains, with optional relaxation. `shape-memory`: springs from nodes to their places in a reference "
          "shape that follows the cell."),
      row("young_modulus_Pa", &E::young_modulus_Pa, positive, "Young's modulus (Pa)."),
      row("poisson_ratio", &E::poisson_ratio, {.low = -1, .high = 0.5, .low_included = false, .high_included = false},
          "Poisson's ratio; with coupled volumes it affects only the shear modulus and the dilatation within a cell."),
      row("relaxation_s", &E::relaxation_s, positive_or_none,
          "Maxwell relaxation time of the stress-free shape (s), model `neo-hookean`."),
      row("relaxation_min", &E::relaxation_s, positive_or_none, "`relaxation_s` in minutes.",
          {.instead_of = "relaxation_s", .scale = 60}),
      row("attractor_stiffness_nN_per_um", &E::attractor_stiffness_nN_per_um,
          {.low = 0, .low_included = false, .word_for_none = "derived"},
          "Stiffness of the `shape-memory` springs (nN/µm), or derived: mean shear modulus as by Young's modulus and "
          "Poisson's ratio."),
      row("attractor_preload_nN", &E::attractor_preload_nN, not_negative,
          "Pre-tension of these springs, independent of length (nN)."),
      row("attractor_preload_length_um", &E::attractor_preload_length_um, positive,
          "Spring length at which 0.7 of the pre-tension acts (µm); its direction is undefined at 0."),
      row("corner_barrier_Pa", &E::corner_barrier_Pa, {.low = 0, .word_for_none = "automatic"},
          "Inversion barrier (Pa): energy that diverges as a corner Jacobian vanishes, active below 0.15 of its "
          "reference value; 0: off. `automatic`: a tenth of Young's modulus if cells are polygons, come from a file or "
          "divide, else 0."),
  };
  info.rules = check_elasticity;
  info.build = build;
  return info;
}

ScenarioTable region_elasticity_table() {
  using namespace of_elasticity;
  ScenarioTable info{
      "elasticity.*",
      "Different elasticity of a region or layer; default values are those of `[elasticity]`. Tables must not overlap.",
      "Passive mechanics"};
  const auto row = key_rows(info, &Scenario::region_elasticities);
  info.rows = {
      row("region", &R::region, anything, "Cells with these values.", {.required = true}),
      row("height_percent", &R::height_percent, between(0, 100),
          "Layer: only elements with their centre in this part of the cell height (0: basal, 100: apical). Requires "
          "several elements through the height."),
      row("young_modulus_Pa", &R::young_modulus_Pa, positive, "Young's modulus (Pa), times `profile` and `variation`."),
      row("poisson_ratio", &R::poisson_ratio, {.low = -1, .high = 0.5, .low_included = false, .high_included = false},
          "Poisson's ratio."),
      row("relaxation_s", &R::relaxation_s, positive,
          "Relaxation time of the stress-free shape (s), model `neo-hookean`."),
      row("relaxation_min", &R::relaxation_s, positive, "`relaxation_s` in minutes.",
          {.instead_of = "relaxation_s", .scale = 60}),
  };
  add_strengths(info.rows, acting(row));
  info.check = check_regions;
  list_acting(info, &Scenario::region_elasticities, nullptr, check_region_elasticity);
  return info;
}

}  // namespace plica
