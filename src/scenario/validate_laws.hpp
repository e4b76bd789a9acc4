// The rules between several keys of one law: elasticity, contraction. Called by validate (validate.hpp).
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Keys of the attractor belong to the model "shape-memory": with another they are an error where they were given along
/// with the model or after it, and dropped where they were inherited from a scenario of the other model.
void check_elasticity(ElasticityInput& elasticity, Input& input);

/// Profile and delay of the contraction at `table` ("contraction.NAME"): what their shape needs and what has no meaning
/// with it, as above; settles their axis and where a wave starts.
void check_pattern(const std::string& table, ContractionInput& contraction, Input& input);

}  // namespace plica
