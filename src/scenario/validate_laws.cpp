// Keys that only one choice of another key uses: given in vain is an error, inherited in vain is dropped.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

#include "scenario/validate.hpp"
#include "scenario/words.hpp"

namespace plica {
namespace {

/// Gives `field` its default; an error where it was given another value along with a choice that does not use it.
template <class T>
void drop(const std::string& address, T& field, const T& default_value, const std::string& chooser,
          const std::string& problem, const std::string& remedy, Input& input) {
  if (field != default_value && input.given_with(address, chooser)) input.report(address, problem, remedy);
  field = default_value;
}

void check_profile(const std::string& path, ProfileInput& profile, Input& input) {
  const std::string chooser = path + ".shape";
  if (!input.sound(path) || !input.sound(chooser)) return;
  if ((profile.shape.empty() || profile.shape == "constant") && !profile.full_length_um)
    for (const auto& [key, value] : {std::pair(".middle", &profile.middle), {".edge", &profile.edge}})
      drop(path + key, *value, {}, input.place(chooser) == nullptr ? path + key : chooser,
           "has no meaning where nothing fades", "remove it, or choose another shape, or a taper", input);
  if (profile.shape.empty()) {
    if (!profile.axis.empty() || profile.sigma_um || profile.sigma_cells || profile.half_width_um ||
        profile.full_cells || profile.fade_cells)
      input.report(chooser, "is missing",
                   fmt::format("give one of: {}", fmt::join(words_of(words::profile_shapes), " | ")));
    return;
  }
  if (profile.axis.empty()) profile.axis = "across";
  const auto need = [&](const std::string& key, const std::optional<double>& value, const std::string& remedy) {
    if (!value && input.sound(path + key)) input.report(path + key, "is missing", remedy);
  };
  const auto only = [&](const std::string& shape, const std::string& key, std::optional<double>& value) {
    if (profile.shape != shape)
      drop(path + key, value, {}, chooser, fmt::format("has no meaning with shape \"{}\"", profile.shape),
           fmt::format("remove it, or choose shape {}", shape), input);
  };
  only("linear", ".half_width_um", profile.half_width_um);
  only("gaussian", ".sigma_um", profile.sigma_um);
  only("gaussian", ".sigma_um", profile.sigma_cells);  // stands in for it
  only("plateau", ".full_cells", profile.full_cells);
  only("plateau", ".fade_cells", profile.fade_cells);
  if (profile.shape == "linear")
    need(".half_width_um", profile.half_width_um, "give the distance at which the factor is edge, a number > 0");
  if (profile.shape == "gaussian" && !profile.sigma_cells)
    need(".sigma_um", profile.sigma_um, "give the width of the gaussian, a number > 0, or sigma_cells");
  if (profile.shape == "plateau") {
    need(".full_cells", profile.full_cells, "give how many cells have the factor of the middle, a number > 0");
    need(".fade_cells", profile.fade_cells, "give over how many cells it fades, 0 for none");
  }
}

void check_taper(const std::string& path, const ProfileInput& profile, Input& input) {
  if (!input.sound(path) || profile.full_length_um.has_value() == profile.fade_um.has_value()) return;
  const std::string key = profile.full_length_um ? ".fade_um" : ".full_length_um";
  if (input.sound(path + key)) input.report(path + key, "is missing", "a taper along the axis has both lengths");
}

void check_delay(const std::string& path, DelayInput& delay, Input& input) {
  const std::string chooser = path + ".speed_um_per_s";
  if (!input.sound(path) || !input.sound(chooser)) return;
  if (delay.speed_um_per_s) {
    if (delay.axis.empty()) delay.axis = "along";
    if (delay.from.empty()) delay.from = "middle";
  } else if (input.place(chooser) == nullptr && (!delay.axis.empty() || !delay.from.empty())) {
    input.report(chooser, "is missing", "give the speed of the wave, a number > 0, or \"none\"");
  } else {
    const std::string problem = "has no meaning with speed \"none\"", remedy = "remove it, or give a speed";
    drop(path + ".axis", delay.axis, {}, chooser, problem, remedy, input);
    drop(path + ".from", delay.from, {}, chooser, problem, remedy, input);
  }
}

}  // namespace

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

void check_region_elasticities(const Scenario& scenario, Input& input) {
  const ElasticModel model = model_of(scenario.elasticity);
  for (const auto& [name, it] : scenario.region_elasticities) {
    const std::string table = "elasticity." + name;
    if (!input.sound(table) || !input.sound("elasticity.model")) continue;
    const auto sound = [&](const std::string& key) { return input.sound(table + key); };
    if (model == ElasticModel::shape_memory)
      input.report(table, "model \"shape-memory\" is the same in all cells",
                   "remove it, or choose model \"corotational\" or \"neo-hookean\"");
    else if (!it.young_modulus_Pa && !it.relaxation_s && sound(".young_modulus_Pa") && sound(".relaxation_s"))
      input.report(table, "does nothing", "give young_modulus_Pa or relaxation_min");
    else if (it.relaxation_s && model != ElasticModel::neo_hookean)
      input.report(table + ".relaxation_s", fmt::format("has no meaning with model \"{}\"", scenario.elasticity.model),
                   "remove it, or choose model \"neo-hookean\"");
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

void check_pattern(const std::string& table, ProfileInput& profile, DelayInput& delay, Input& input) {
  if (!input.sound(table)) return;
  check_taper(table + ".profile", profile, input);
  check_profile(table + ".profile", profile, input);
  check_delay(table + ".delay", delay, input);
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
  if (method_of(scenario.volume) == VolumeMethod::projection || scenario.time.scheme != "newton")
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
    if (state == EnclosedState::held &&
        (method_of(scenario.volume) == VolumeMethod::projection || scenario.time.scheme != "newton"))
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
