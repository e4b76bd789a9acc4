// Rules between several keys of a scenario. Rules of a single key are in the table of schema.cpp.
#pragma once

#include "scenario/input.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Reports inconsistent keys to `input` and sets defaults that depend on other keys: fields that the embryo's shape
/// does not use, the length of a sphere (its diameter), the vitelline membrane of a block (none), values that are
/// "automatic".
void validate(Scenario& scenario, Input& input);

/// Returns what second order in time does not support in a scenario; empty if nothing.
std::string what_bars_second_order(const Scenario& scenario);

// Parts of validate().

/// Resets `field` to its default. Reports an error if it was set together with, or after, a choice that does not use
/// it.
template <class T>
void drop(const std::string& address, T& field, const T& default_value, const std::string& chooser,
          const std::string& problem, const std::string& remedy, Input& input) {
  if (field != default_value && input.given_with(address, chooser)) input.report(address, problem, remedy);
  field = default_value;
}

/// Checks keys of monitors against their quantity, criteria for bounds and monitors, and expectations of monitors.
void check_monitors(const Scenario& scenario, Input& input);

/// Checks keys of the elastic model: attractor keys belong to "shape-memory", relaxation to "neo-hookean". With another
/// model, keys set together with it or later are errors; inherited ones are dropped. Also checks the limits of the
/// neo-Hookean law.
void check_elasticity(Scenario& scenario, Input& input);

/// Checks elastic properties of regions against the model.
void check_region_elasticities(Scenario& scenario, Input& input);

/// Checks keys of the projection and of the conjugate gradients, likewise.
void check_volume_and_time(VolumeInput& volume, TimeInput& time, Input& input);

/// Check profile, delay and pulse of `table` ("contraction.NAME"): keys that the shape requires or does not use, as
/// above. Set default axis, wave origin and phase.
void check_profile(const std::string& table, ProfileInput& profile, Input& input);
void check_delay(const std::string& table, DelayInput& delay, Input& input);
void check_pulse(const std::string& table, PulseInput& pulse, const TimeInput& time, Input& input);

/// Checks that other settings support self-contact.
void check_contact(const Scenario& scenario, Input& input);

/// Checks enclosed volumes: closed sheet, and room to move.
void check_enclosed(Scenario& scenario, Input& input);

/// Checks trigger and follow of a cortex.
void check_own_state(const std::string& table, const CortexInput& cortex, Input& input);

/// Checks a cortex for keys without effect.
void check_cortex(const std::string& table, const CortexInput& cortex, Input& input);

/// Checks the time or threshold of a division; `table`: "division.NAME".
void check_division(const std::string& table, const DivisionInput& division, Input& input);

/// Checks times and affected tables of an ablation.
void check_ablation(const std::string& name, const Scenario& scenario, Input& input);

}  // namespace plica
