// Keys that only one choice of another key uses: given in vain is an error, inherited in vain is dropped.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "scenario/validate.hpp"
#include "scenario/words.hpp"

namespace plica {
void check_elasticity(Scenario& scenario, Input& input) {
  if (!input.sound("elasticity.model")) return;
  ElasticityInput& elasticity = scenario.elasticity;
  const ElasticityInput defaults;
  const auto only = [&](const std::string& model, const std::string& key, auto ElasticityInput::*field) {
    if (elasticity.model != model)
      drop("elasticity." + key, elasticity.*field, defaults.*field, "elasticity.model",
           fmt::format("has no meaning with model \"{}\"", elasticity.model),
           fmt::format("remove it, or choose model \"{}\"", model), input);
  };
  only("shape-memory", "attractor_stiffness_nN_per_um", &ElasticityInput::attractor_stiffness_nN_per_um);
  only("shape-memory", "attractor_preload_nN", &ElasticityInput::attractor_preload_nN);
  only("shape-memory", "attractor_preload_length_um", &ElasticityInput::attractor_preload_length_um);
  only("neo-hookean", "relaxation_s", &ElasticityInput::relaxation_s);
  if (model_of(elasticity) != ElasticModel::neo_hookean) return;
  if (elasticity.poisson_ratio < 0 && input.sound("elasticity.poisson_ratio"))
    input.report("elasticity.poisson_ratio",
                 fmt::format("{} is below 0, which model \"neo-hookean\" cannot have", elasticity.poisson_ratio),
                 "give a number >= 0, or choose model \"corotational\"");
  if (scenario.dynamics.shear_viscosity_Pa_s > 0 && input.sound("dynamics.shear_viscosity_Pa_s"))
    input.report("dynamics.shear_viscosity_Pa_s", "model \"neo-hookean\" has no such viscosity",
                 "give 0, and elasticity.relaxation_min for cells that flow, or choose model \"corotational\"");
}

void check_region_elasticities(Scenario& scenario, Input& input) {
  const ElasticModel model = model_of(scenario.elasticity);
  for (auto& [name, it] : scenario.region_elasticities) {
    const std::string table = "elasticity." + name;
    if (!input.sound(table) || !input.sound("elasticity.model")) continue;
    const auto sound = [&](const std::string& key) { return input.sound(table + key); };
    check_profile(table, it.profile, input);
    if (model == ElasticModel::shape_memory)
      input.report(table, "model \"shape-memory\" is the same in all cells",
                   "remove it, or choose model \"corotational\" or \"neo-hookean\"");
    else if (!it.young_modulus_Pa && !it.poisson_ratio && !it.relaxation_s && it.profile.shape.empty() &&
             it.variation.spread == 0 && sound(".young_modulus_Pa") && sound(".poisson_ratio") &&
             sound(".relaxation_s") && sound(".profile") && sound(".profile.shape") && sound(".variation.spread"))
      input.report(table, "does nothing", "give young_modulus_Pa, poisson_ratio, relaxation_min, profile or variation");
    else if (it.relaxation_s && model != ElasticModel::neo_hookean)
      input.report(table + ".relaxation_s", fmt::format("has no meaning with model \"{}\"", scenario.elasticity.model),
                   "remove it, or choose model \"neo-hookean\"");
    if (it.poisson_ratio && *it.poisson_ratio < 0 && model == ElasticModel::neo_hookean && sound(".poisson_ratio"))
      input.report(table + ".poisson_ratio",
                   fmt::format("{} is below 0, which model \"neo-hookean\" cannot have", *it.poisson_ratio),
                   "give a number >= 0, or choose model \"corotational\"");
    if (it.height_percent && !scenario.divisions.empty() && sound(".height_percent"))
      input.report(table + ".height_percent", "cells with layers do not divide", "remove it, or [division]");
  }
}

void check_volume_and_time(VolumeInput& volume, TimeInput& time, Input& input) {
  const auto check = [&]<class Table>(Table& table, auto Table::*field, const std::string& address,
                                      const std::string& chooser, const std::string& choice) {
    if (input.sound(chooser) && input.sound(address))
      drop(address, table.*field, Table().*field, chooser,
           fmt::format("is used with {} = \"{}\" only", chooser, choice),
           fmt::format("remove it, or give {} = \"{}\"", chooser, choice), input);
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
  // Given as 0 it is switched off, with all that belongs to it.
  const auto is_missing = [&](double value, const std::string& name) {
    return value == 0 && input.place(table + "." + name) == nullptr;
  };
  if (is_missing(cortex.tension_mN_per_m, "tension_mN_per_m") &&
      is_missing(cortex.stiffness_mN_per_m, "stiffness_mN_per_m") &&
      is_missing(cortex.crowding_mN_per_m, "crowding_mN_per_m"))
    input.report(table, "does nothing", "give tension_mN_per_m, stiffness_mN_per_m or crowding_mN_per_m");
  // A key that scales something that is not there.
  const auto needs = [&](const std::string& key, bool is_given, double what, const std::string& name) {
    if (is_given && is_missing(what, name))
      input.report(table + key, "has no meaning without " + name, "remove it, or give " + name);
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
  const std::string measures = fmt::format("give one of: {}", fmt::join(words_of(words::own_measures), " | "));
  if (measure.empty() && (below || above)) report(".trigger.measure", "is missing", measures);
  if (!measure.empty() && below.has_value() == above.has_value())
    report(below ? ".trigger.above" : ".trigger.below", below ? "stands beside below" : "is missing",
           "give below or above, one of them");
  if (!measure.empty() && cortex.delay.speed_um_per_s)
    report(".trigger", "stands beside a delay, which starts cells by the clock", "give one of the two");
  if (follow.measure.empty() && (follow.from || follow.to)) report(".follow.measure", "is missing", measures);
  if (follow.measure.empty()) return;
  if (!follow.from) report(".follow.from", "is missing", "give where the factor is 0");
  if (!follow.to) report(".follow.to", "is missing", "give where the factor is 1");
  if (follow.from && follow.from == follow.to)
    report(".follow.to", "is where the factor is 0, too", "give another value than from");
  if (!measure.empty()) report(".follow", "stands beside a trigger", "give one of the two");
  if (cortex.tension_mN_per_m == 0 && input.place(table + ".tension_mN_per_m") == nullptr)
    report(".follow", "has no meaning without tension_mN_per_m", "remove it, or give tension_mN_per_m");
}

void check_contact(const Scenario& scenario, Input& input) {
  if (!input.sound("self_contact") || !input.sound("self_contact.surface")) return;
  const SelfContactInput& contact = scenario.self_contact;
  if (contact.surface == "none" && contact.friction > 0 && input.sound("self_contact.friction"))
    input.report("self_contact.friction", "has no meaning with surface \"none\"",
                 "remove it, or choose a surface, such as \"apical\"");
  if (contact.surface == "none") return;
  if (!scenario.divisions.empty())
    input.report("self_contact.surface", "contact does not go with division yet", "remove one of the two");
  if (is_as_in_the_paper(scenario))
    input.report("self_contact.surface", "contact goes with time.scheme \"newton\" and volumes that are not projected",
                 "give \"none\", or another scheme or volume.method");
  if (contact.search_um < 2 * contact.distance_um && input.sound("self_contact.search_um"))
    input.report("self_contact.search_um", fmt::format("{} is under twice distance_um", contact.search_um),
                 "give several times distance_um");
}

void check_enclosed(Scenario& scenario, Input& input) {
  bool is_kept = false;
  for (auto& [name, it] : scenario.enclosed) {
    const std::string table = "enclosed." + name, key = table + ".bulk_modulus_Pa";
    if (!input.sound(table) || !input.sound(table + ".volume") || !input.sound("embryo.shape")) continue;
    const EnclosedState state = meaning_of(words::enclosed_states, it.volume);
    if (is_patch(shape_of(scenario.embryo)))
      input.report(table, fmt::format("a {} encloses nothing", scenario.embryo.shape),
                   "remove it, or choose shape \"pill\" or \"sphere\"");
    if (state == EnclosedState::compliant && !it.bulk_modulus_Pa && input.sound(key))
      input.report(key, "is missing", "give how compliant the volume is, a number > 0");
    if (state != EnclosedState::compliant)
      drop(key, it.bulk_modulus_Pa, {}, table + ".volume", fmt::format("has no meaning with volume \"{}\"", it.volume),
           "remove it, or choose volume \"compliant\"", input);
    if (state == EnclosedState::held && is_as_in_the_paper(scenario))
      input.report(table + ".volume",
                   "a held volume goes with time.scheme \"newton\" and volumes that are not projected",
                   "give \"compliant\", or another scheme or volume.method");
    else if (state != EnclosedState::free && std::exchange(is_kept, true))
      input.report(table + ".surface", "its volume is kept by another table already", "remove one of the two");
    // Cells, what they enclose, and the room up to the shell: with all three given cells slide along the shell at most.
    if (state == EnclosedState::held && scenario.vitelline.enabled && scenario.vitelline.gap_um == 0 &&
        method_of(scenario.volume) == VolumeMethod::coupled && input.sound("vitelline.gap_um"))
      input.report(
          table + ".volume",
          "no cell can leave the shell: cells and what they enclose keep their volumes, and the shell leaves no room",
          "give vitelline.gap_um, such as 0.5, or volume \"compliant\"");
  }
}

}  // namespace plica
