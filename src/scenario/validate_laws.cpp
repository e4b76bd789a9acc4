#include "scenario/validate_laws.hpp"

#include <fmt/format.h>

namespace plica {

void check_elasticity(ElasticityInput& elasticity, Input& input) {
  if (!input.sound("elasticity.model") || elasticity.model == "shape-memory") return;
  const ElasticityInput defaults;
  const Place* model = input.place("elasticity.model");
  const auto check = [&](const std::string& key, auto ElasticityInput::*field) {
    const Place* place = input.place("elasticity." + key);
    const bool later = place != nullptr && (model == nullptr || place->layer >= model->layer);
    if (later && elasticity.*field != defaults.*field)
      input.report("elasticity." + key, fmt::format("has no meaning with model \"{}\"", elasticity.model),
                   "remove it, or choose model \"shape-memory\"");
    elasticity.*field = defaults.*field;
  };
  check("attractor_stiffness_nN_per_um", &ElasticityInput::attractor_stiffness_nN_per_um);
  check("attractor_preload_nN", &ElasticityInput::attractor_preload_nN);
  check("attractor_preload_length_um", &ElasticityInput::attractor_preload_length_um);
}

}  // namespace plica
