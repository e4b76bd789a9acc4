// The rules between several keys of a scenario. Those of a single key are in the table of schema.cpp.
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Reports to `input` what does not fit together, and settles defaults that depend on other keys: fields that the
/// embryo's shape does not use, a sphere's length (its diameter), a block's shell (none).
void validate(Scenario& scenario, Input& input);

// Parts of it.

/// Gives `field` its default; an error where it was given another value along with a choice that does not use it.
template <class T>
void drop(const std::string& address, T& field, const T& default_value, const std::string& chooser,
          const std::string& problem, const std::string& remedy, Input& input) {
  if (field != default_value && input.given_with(address, chooser)) input.report(address, problem, remedy);
  field = default_value;
}

/// Reports monitors whose keys do not fit their quantity, criteria that bound nothing or what is not there, and
/// expectations of monitors that are not there.
void check_monitors(const Scenario& scenario, Input& input);

/// Keys of the attractor belong to the model "shape-memory", relaxation to "neo-hookean": with another they are an
/// error where they were given along with the model or after it, and dropped where they were inherited from a scenario
/// of the other model. And what a neo-Hookean law cannot be.
void check_elasticity(Scenario& scenario, Input& input);

/// Other values in a region: which, and of which model.
void check_region_elasticities(Scenario& scenario, Input& input);

/// The same of the projection's keys, and of those of the conjugate gradients.
void check_volume_and_time(VolumeInput& volume, TimeInput& time, Input& input);

/// Profile, delay and pulses of what acts at `table` ("contraction.NAME"): what their shape needs and what has no
/// meaning with it, as above; settles their axis, where a wave starts, and the phase.
void check_profile(const std::string& table, ProfileInput& profile, Input& input);
void check_delay(const std::string& table, DelayInput& delay, Input& input);
void check_pulse(const std::string& table, PulseInput& pulse, const TimeInput& time, Input& input);

/// Self-contact: with what it goes.
void check_contact(const Scenario& scenario, Input& input);

/// Enclosed volumes: of a sheet that is closed, with room to move.
void check_enclosed(Scenario& scenario, Input& input);

/// What starts a cortex's programs, or what its tension follows.
void check_own_state(const std::string& table, const CortexInput& cortex, Input& input);

/// What of a cortex has nothing that it could act on.
void check_cortex(const std::string& table, const CortexInput& cortex, Input& input);

}  // namespace plica
