// Keys used with one choice of another key only: unused ones are errors if set, and dropped if inherited.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "core/clock.hpp"
#include "scenario/suggest.hpp"
#include "scenario/validate.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

/// Names of the cortices and contractions, as used by `ablation.NAME.only`.
std::vector<std::string> active_tables(const Scenario& scenario) {
  std::vector<std::string> tables;
  for (const auto& [name, it] : scenario.cortices) tables.push_back("cortex." + name);
  for (const auto& [name, it] : scenario.contractions) tables.push_back("contraction." + name);
  return tables;
}

}  // namespace

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

void check_region_elasticities(Scenario& scenario, Input& input) {
  const ElasticModel model = model_of(scenario.elasticity);
  for (auto& [name, it] : scenario.region_elasticities) {
    const std::string table = "elasticity." + name;
    if (!input.sound(table) || !input.sound("elasticity.model")) continue;
    const auto sound = [&](const std::string& key) { return input.sound(table + key); };
    check_profile(table, it.profile, input);
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
    if (it.height_percent && !scenario.divisions.empty() && sound(".height_percent"))
      input.report(table + ".height_percent", "cells with layers cannot divide",
                   "remove height_percent, or [division]");
  }
}

void check_volume_and_time(VolumeInput& volume, TimeInput& time, Input& input) {
  const auto check = [&]<class Table>(Table& table, auto Table::*field, const std::string& address,
                                      const std::string& chooser, const std::string& choice) {
    if (input.sound(chooser) && input.sound(address))
      drop(address, table.*field, Table().*field, chooser,
           fmt::format("is used only with {} = \"{}\"", chooser, choice),
           fmt::format("remove it, or set {} to \"{}\"", chooser, choice), input);
  };
  if (method_of(volume) != VolumeMethod::projection) {
    const std::string chooser = "volume.method", choice = "projection";
    check(volume, &VolumeInput::projection_surface, "volume.projection_surface", chooser, choice);
    check(volume, &VolumeInput::projection_weights, "volume.projection_weights", chooser, choice);
  }
  if (time.scheme != "linearly-implicit") {
    const std::string chooser = "time.scheme", choice = "linearly-implicit";
    check(time, &TimeInput::cg_tolerance, "time.cg_tolerance", chooser, choice);
    check(time, &TimeInput::cg_max_iterations, "time.cg_max_iterations", chooser, choice);
  }
}

void check_cortex(const std::string& table, const CortexInput& cortex, Input& input) {
  for (const char* key : {"", ".tension_mN_per_m", ".stiffness_mN_per_m", ".crowding_mN_per_m"})
    if (!input.sound(table + key)) return;
  // A value set to 0 is switched off on purpose, so the keys that depend on it are no error.
  const auto is_missing = [&](double value, const std::string& name) {
    return value == 0 && input.place(table + "." + name) == nullptr;
  };
  if (is_missing(cortex.tension_mN_per_m, "tension_mN_per_m") &&
      is_missing(cortex.stiffness_mN_per_m, "stiffness_mN_per_m") &&
      is_missing(cortex.crowding_mN_per_m, "crowding_mN_per_m"))
    input.report(table, "has no effect", "set tension_mN_per_m, stiffness_mN_per_m or crowding_mN_per_m");
  // Keys that modify a missing quantity.
  const auto needs = [&](const std::string& key, bool is_given, double what, const std::string& name) {
    if (is_given && is_missing(what, name))
      input.report(table + key, "is not used without " + name, "remove it, or set " + name);
  };
  needs(".saturation_ratio", cortex.saturation_ratio > 0, cortex.tension_mN_per_m, "tension_mN_per_m");
  needs(".program", !cortex.program.activity.empty(), cortex.tension_mN_per_m, "tension_mN_per_m");
  needs(".compression_ratio", cortex.compression_ratio < 1, cortex.stiffness_mN_per_m, "stiffness_mN_per_m");
  needs(".relaxation_s", cortex.relaxation_s.has_value(), cortex.stiffness_mN_per_m, "stiffness_mN_per_m");
  needs(".stiffness_program", !cortex.stiffness_program.activity.empty(), cortex.stiffness_mN_per_m,
        "stiffness_mN_per_m");
}

void check_own_state(const std::string& table, const CortexInput& cortex, Input& input) {
  const auto& [measure, below, above] = cortex.trigger;
  const FollowInput& follow = cortex.follow;
  for (const std::string& part : {table, table + ".trigger", table + ".follow"})
    if (!input.sound(part)) return;
  const auto report = [&](const std::string& key, const std::string& problem, const std::string& remedy) {
    if (input.sound(table + key)) input.report(table + key, problem, remedy);
  };
  const std::string measures =
      fmt::format("set measure to one of: {}", fmt::join(words_of(words::own_measures), " | "));
  if (measure.empty() && (below || above)) report(".trigger.measure", "is missing", measures);
  if (!measure.empty() && below.has_value() == above.has_value())
    report(below ? ".trigger.above" : ".trigger.below", below ? "conflicts with below" : "is missing",
           "set either below or above");
  if (!measure.empty() && cortex.delay.speed_um_per_s)
    report(".trigger", "conflicts with `delay`, which activates cells at prescribed times", "remove one of them");
  if (follow.measure.empty() && (follow.from || follow.to)) report(".follow.measure", "is missing", measures);
  if (follow.measure.empty()) return;
  if (!follow.from) report(".follow.from", "is missing", "set `from` to the value at which the factor is 0");
  if (!follow.to) report(".follow.to", "is missing", "set `to` to the value at which the factor is 1");
  if (follow.from && follow.from == follow.to) report(".follow.to", "equals `from`", "set `to` to a different value");
  if (!measure.empty()) report(".follow", "conflicts with `trigger`", "remove one of them");
  if (cortex.tension_mN_per_m == 0 && input.place(table + ".tension_mN_per_m") == nullptr)
    report(".follow", "is not used without tension_mN_per_m", "remove it, or set tension_mN_per_m");
}

void check_contact(const Scenario& scenario, Input& input) {
  if (!input.sound("self_contact") || !input.sound("self_contact.surface")) return;
  const SelfContactInput& contact = scenario.self_contact;
  if (contact.surface == "none" && contact.friction > 0 && input.sound("self_contact.friction"))
    input.report("self_contact.friction", "is not used with surface \"none\"",
                 "remove friction, or set surface, for example to \"apical\"");
  if (contact.surface == "none") return;
  if (!scenario.divisions.empty())
    input.report("self_contact.surface", "self-contact does not support division",
                 "remove [self_contact] or [division]");
  if (is_as_in_the_paper(scenario))
    input.report("self_contact.surface",
                 "self-contact requires time.scheme \"newton\" and a volume.method other than \"projection\"",
                 "set surface to \"none\", or change time.scheme or volume.method");
  if (contact.search_um < 2 * contact.distance_um && input.sound("self_contact.search_um"))
    input.report("self_contact.search_um", fmt::format("{} is below twice distance_um", contact.search_um),
                 "set search_um to several times distance_um");
}

void check_enclosed(Scenario& scenario, Input& input) {
  bool is_kept = false;
  for (auto& [name, it] : scenario.enclosed) {
    const std::string table = "enclosed." + name, key = table + ".bulk_modulus_Pa";
    if (!input.sound(table) || !input.sound(table + ".volume") || !input.sound("embryo.shape")) continue;
    const EnclosedState state = meaning_of(words::enclosed_states, it.volume);
    if (is_patch(shape_of(scenario.embryo)))
      input.report(table, fmt::format("a {} encloses no volume", scenario.embryo.shape),
                   "remove the table, or set embryo.shape to \"pill\" or \"sphere\"");
    if (state == EnclosedState::compliant && !it.bulk_modulus_Pa && input.sound(key))
      input.report(key, "is missing", "set bulk_modulus_Pa to a number > 0");
    if (state != EnclosedState::compliant)
      drop(key, it.bulk_modulus_Pa, {}, table + ".volume", fmt::format("is not used with volume \"{}\"", it.volume),
           "remove bulk_modulus_Pa, or set volume to \"compliant\"", input);
    if (state == EnclosedState::held && is_as_in_the_paper(scenario))
      input.report(table + ".volume",
                   "\"held\" requires time.scheme \"newton\" and a volume.method other than \"projection\"",
                   "set volume to \"compliant\", or change time.scheme or volume.method");
    else if (state != EnclosedState::free && std::exchange(is_kept, true))
      input.report(table + ".surface", "another table already constrains this volume", "remove one of the two tables");
    // With cell volumes, enclosed volume and shell volume all fixed, cells can only slide along the shell.
    if (state == EnclosedState::held && scenario.vitelline.enabled && scenario.vitelline.gap_um == 0 &&
        method_of(scenario.volume) == VolumeMethod::coupled && input.sound("vitelline.gap_um"))
      input.report(
          table + ".volume",
          "no cell can leave the vitelline membrane, since cell and enclosed volumes are fixed and the gap is 0",
          "set vitelline.gap_um, for example to 0.5, or volume to \"compliant\"");
  }
}

void check_division(const std::string& table, const DivisionInput& division, Input& input) {
  for (const char* key : {".at_s", ".when", ".threshold"})
    if (!input.sound(table) || !input.sound(table + key)) return;
  if (division.at_s && !division.when.empty())
    input.report(table + ".when", "conflicts with the division time, which is also set", "remove one of them");
  if (!division.at_s && division.when.empty())
    input.report(table, "no division time", "set at_s, at_min, or when with threshold");
  if (!division.when.empty() && !division.threshold)
    input.report(table + ".threshold", "is missing", "set threshold to the value at which cells divide");
  if (division.when.empty() && division.threshold)
    input.report(table + ".threshold", "is not used without `when`", "remove threshold, or set when");
}

void check_ablation(const std::string& name, const Scenario& scenario, Input& input) {
  const AblationInput& ablation = scenario.ablations.at(name);
  const std::string table = "ablation." + name;
  const std::vector<std::string> known = active_tables(scenario);
  for (const std::string& other : ablation.only)
    if (std::ranges::find(known, other) == known.end() && input.sound(table + ".only") && input.sound(other))
      input.report(table + ".only", fmt::format("[{}] does not exist", other), did_you_mean(other, known));
  for (const std::string key : {"", ".at_s", ".at_min", ".until_s", ".until_min"})
    if (!input.sound(table + key)) return;
  if (!ablation.at_s) return input.report(table, "no start time", "set at_min or at_s (0 = from the start)");
  if (ablation.until_s && has_come(*ablation.until_s, *ablation.at_s))
    input.report(table + ".until_s", "is not after the start of the ablation", "set a later time, or \"none\"");
}

}  // namespace plica
