// The rules between several keys of a scenario. Those of a single key are in the table of schema.cpp.
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Reports to `input` what does not fit together, and settles defaults that depend on other keys: fields that the
/// embryo's shape does not use, a sphere's length (its diameter), a block's shell (none).
void validate(Scenario& scenario, Input& input);

// Parts of it.

/// Reports monitors whose keys do not fit their quantity, criteria that bound nothing or what is not there, and
/// expectations of monitors that are not there.
void check_monitors(const Scenario& scenario, Input& input);

/// Keys of the attractor belong to the model "shape-memory", relaxation to "neo-hookean": with another they are an
/// error where they were given along with the model or after it, and dropped where they were inherited from a scenario
/// of the other model. And what a neo-Hookean law cannot be.
void check_elasticity(Scenario& scenario, Input& input);

/// Other values in a region: which, and of which model.
void check_region_elasticities(const Scenario& scenario, Input& input);

/// The same of the projection's keys, and of those of the conjugate gradients.
void check_volume_and_time(VolumeInput& volume, TimeInput& time, Input& input);

/// Profile and delay of what acts at `table` ("contraction.NAME"): what their shape needs and what has no meaning with
/// it, as above; settles their axis and where a wave starts.
void check_pattern(const std::string& table, ProfileInput& profile, DelayInput& delay, Input& input);

/// Self-contact: with what it goes.
void check_contact(const Scenario& scenario, Input& input);

/// Enclosed volumes: of a sheet that is closed, with room to move.
void check_enclosed(Scenario& scenario, Input& input);

/// What starts a cortex's programs, or what its tension follows.
void check_own_state(const std::string& table, const CortexInput& cortex, Input& input);

/// What of a cortex has nothing that it could act on.
void check_cortex(const std::string& table, const CortexInput& cortex, Input& input);

}  // namespace plica
