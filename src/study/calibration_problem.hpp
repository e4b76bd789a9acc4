// Calibration problem: keys with bounds and targets with tolerances; parsing and checks.
#pragma once

#include <string>
#include <vector>

#include "scenario/load.hpp"

namespace plica {

/// Key of the scenario to fit between `low` and `high`, in its own unit.
struct VariedKey {
  std::string key;  // dotted, as in --set
  double low = 0, high = 0;
};

/// Target for a number of summary.json: `value` +- `within`.
struct Target {
  std::string name;
  double value = 0, within = 0;
};

struct CalibrationProblem {
  ScenarioSource source;
  std::vector<std::string> overrides;  // as of --set
  std::vector<VariedKey> keys;
  std::vector<Target> targets;
  int most_trials = 40;
};

/// Parse "KEY=LOW:HIGH". Throws UsageError for another form, or unless low < high.
VariedKey parse_varied_key(const std::string& text);

/// Parse "NAME=VALUE", "NAME=VALUE~WITHIN" (in the unit of the value) or "NAME=VALUE~PERCENT%"; default 0.5 %. Throws
/// UsageError for another form or a tolerance not above 0.
Target parse_target(const std::string& text);

/// Check the problem before any run. Throws UsageError (invalid bounds or tolerance, repeated key or target, unknown
/// target) or ScenarioError (unknown key, or bounds outside its range).
void check_calibration(const CalibrationProblem& problem);

/// Convert a point (coordinates in [0, 1]; keys) to values of the keys, rounded to a millionth of the bounds' width, so
/// that the values written are those run.
std::vector<double> values_at(const CalibrationProblem& problem, const std::vector<double>& place);

/// Starting point: the scenario's own values if within the bounds, else the middle of the bounds.
std::vector<double> first_place(const CalibrationProblem& problem);

/// Overrides of the problem followed by those of the values.
std::vector<std::string> trial_overrides(const CalibrationProblem& problem, const std::vector<double>& values);

/// Load the scenario with these values. Throws ScenarioError, located at --vary for an invalid value.
Scenario load_trial(const CalibrationProblem& problem, const std::vector<double>& values);

}  // namespace plica
