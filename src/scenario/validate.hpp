// The rules between several keys of a scenario. Those of a single key are in the table of schema.cpp.
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Reports to `input` what does not fit together, and settles defaults that depend on other keys: fields that the
/// embryo's shape does not use, a sphere's length (its diameter), a block's shell (none).
void validate(Scenario& scenario, Input& input);

}  // namespace plica
