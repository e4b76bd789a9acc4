// Keys that only one choice of another key uses: given in vain is an error, inherited in vain is dropped.
#include <fmt/format.h>

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
  if (profile.shape.empty()) {
    if (!profile.axis.empty() || profile.sigma_um || profile.half_width_um || profile.edge)
      input.report(chooser, "is missing", "give one of: constant | linear | gaussian");
    return;
  }
  if (profile.axis.empty()) profile.axis = "across";
  const auto need = [&](const std::string& key, const std::optional<double>& value, const std::string& remedy) {
    if (!value && input.sound(path + key)) input.report(path + key, "is missing", remedy);
  };
  const auto no_use = [&](const std::string& key, std::optional<double>& value, const std::string& shape) {
    drop(path + key, value, {}, chooser, fmt::format("has no meaning with shape \"{}\"", profile.shape),
         fmt::format("remove it, or choose shape {}", shape), input);
  };
  if (profile.shape == "gaussian") {
    need(".sigma_um", profile.sigma_um, "give the width of the gaussian, a number > 0");
  } else {
    no_use(".sigma_um", profile.sigma_um, "gaussian");
  }
  if (profile.shape == "linear") {
    need(".half_width_um", profile.half_width_um, "give the distance at which the factor is edge, a number > 0");
    if (!profile.edge) profile.edge = 0;
  } else {
    no_use(".half_width_um", profile.half_width_um, "linear");
    no_use(".edge", profile.edge, "linear");
  }
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

void check_elasticity(ElasticityInput& elasticity, Input& input) {
  if (!input.sound("elasticity.model") || model_of(elasticity) == ElasticModel::shape_memory) return;
  const ElasticityInput defaults;
  const auto check = [&](const std::string& key, auto ElasticityInput::*field) {
    drop("elasticity." + key, elasticity.*field, defaults.*field, "elasticity.model",
         fmt::format("has no meaning with model \"{}\"", elasticity.model),
         "remove it, or choose model \"shape-memory\"", input);
  };
  check("attractor_stiffness_nN_per_um", &ElasticityInput::attractor_stiffness_nN_per_um);
  check("attractor_preload_nN", &ElasticityInput::attractor_preload_nN);
  check("attractor_preload_length_um", &ElasticityInput::attractor_preload_length_um);
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

void check_pattern(const std::string& table, ContractionInput& contraction, Input& input) {
  if (!input.sound(table)) return;
  check_profile(table + ".profile", contraction.profile, input);
  check_delay(table + ".delay", contraction.delay, input);
}

}  // namespace plica
