// Warnings and notes about a valid scenario, for `plica check` and the start of a run; and remedies for a failed time
// step, as changes of the scenario: each names keys that the scenario has.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/setup.hpp"
#include "solver/step/stepper.hpp"

namespace plica {

/// Key and its new value in TOML, as after `--set`.
struct Setting {
  std::string key, value;
};

/// Change of a scenario that cures or delays a failure, and its effect in words.
struct Remedy {
  std::vector<Setting> settings;
  std::string effect;
};

struct Failure {
  StepReport::Status status;
  double time_s = 0;
};

/// Returns the remedies that apply to this scenario, the most effective first. tests/simulation/warnings_test.cpp tries
/// each of them on a run that fails.
std::vector<Remedy> remedies_of(const Scenario& scenario, const Failure& failure);

/// Time courses for all forces that act in full from the start; empty without any.
std::optional<Remedy> gradual_onset(const Scenario& scenario);

/// Lists remedies for a message; empty without any.
std::string remedies_text(const std::vector<Remedy>& remedies);

/// Return what gives cells twice as many elements through the height as they have, to be named in a message: a key of
/// this scenario with its value, or words where it has none.
std::string finer_mesh(const Scenario& scenario, int elements);

/// Returns lines that begin with "warning: " (probably not intended) or "note: " (for information).
std::vector<std::string> advice(const Scenario& scenario, const Model& model);

}  // namespace plica
