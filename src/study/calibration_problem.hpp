// What is to be calibrated: keys between bounds, targets with tolerances; from the command line, and checked.
#pragma once

#include <string>
#include <vector>

#include "scenario/load.hpp"

namespace plica {

/// A key of the scenario that may take any number from low to high, in its own unit.
struct VariedKey {
  std::string key;  // dotted, as in --set
  double low = 0, high = 0;
};

/// A number of summary.json that is to come to `value`, give or take `within`.
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

/// "KEY=LOW:HIGH". UsageError where it is not, or low is not below high.
VariedKey parse_varied_key(const std::string& text);

/// "NAME=VALUE", "NAME=VALUE~WITHIN" (in the unit of the value) or "NAME=VALUE~PERCENT%"; 0.5 % where nothing is said.
/// UsageError where it is none of them, or the tolerance is not over zero.
Target parse_target(const std::string& text);

/// Throws, before anything is run, UsageError (bounds that are none, no tolerance, a key or target twice, a target that
/// the summary does not have) or ScenarioError (a key that is not known, or may not take the values of its bounds).
void check_calibration(const CalibrationProblem& problem);

/// A place, with a coordinate from 0 to 1 for each key, as values of the keys: to a millionth of the bounds' width, so
/// that they are short to write and what is written is what is run.
std::vector<double> values_at(const CalibrationProblem& problem, const std::vector<double>& place);

/// Where to begin: at the scenario's own values where they lie within the bounds, else in the middle of these.
std::vector<double> first_place(const CalibrationProblem& problem);

/// The problem's overrides and those of the values.
std::vector<std::string> trial_overrides(const CalibrationProblem& problem, const std::vector<double>& values);

/// The scenario with these values. ScenarioError says --vary where one of them is wrong.
Scenario load_trial(const CalibrationProblem& problem, const std::vector<double>& values);

}  // namespace plica
