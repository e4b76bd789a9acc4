// Calibration: fit keys of a scenario to targets; each evaluation of the search costs a run.
//
// One number and one coordinate: a bracketing search (TOMS 748: cubic and quadratic interpolation that never leaves the
// bracket). Otherwise COBYLA (Powell 1994) on the misses as equations: it fits each miss by a linear function on n + 1
// points and steps to the smallest largest miss within a shrinking radius. With several keys and targets it acts as
// Newton's method without derivatives and within bounds. Rejected: BOBYQA on the sum of
// squares of the misses, which must learn the curvature of that sum first, and Nelder-Mead: both need three to four
// times as many runs (docs/how-to/calibrate.md).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/observation.hpp"
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

/// One run of the calibration.
struct Trial {
  int number = 0;                            // from 1
  std::vector<double> values;                // keys
  std::vector<std::optional<double>> found;  // targets; empty: no value
  std::string failure;                       // reason for a missing value; empty if all exist
  double worst_miss = 0;                     // largest |found - value| / within; infinite with a failure
  double wall_s = 0;
};

enum class CalibrationEnd {
  met,
  not_met,       // converged: the search finds no values within the bounds that meet the targets
  trials_spent,  // most_trials runs were made
  interrupted,
};

struct Calibration {
  CalibrationEnd end = CalibrationEnd::not_met;
  std::optional<Trial> best;  // smallest worst miss; empty if no trial had a value
  int trials = 0;
};

struct CalibrationHooks {
  std::function<bool()> stop_requested = {};
  std::function<void(int trial, const std::vector<double>& values, const Observation&)> on_row = {};  // while it runs
  std::function<void(const Trial&, bool best_so_far)> on_trial = {};
};

/// Run trials of the scenario one after another, at the points requested by search_targets. Checks the problem first
/// and throws as check_calibration does.
Calibration calibrate(const CalibrationProblem& problem, const CalibrationHooks& hooks = {});

/// Scenario of the best trial, to be saved as `file`: `base`, overrides, fitted values, a comment on the calibration
/// and, if all targets were met, these under [expect]. Written in full if a base would not give the same scenario.
std::string calibrated_toml(const CalibrationProblem& problem, const Calibration& calibration, const std::string& file);

struct Evaluation {
  std::vector<double> misses;  // targets, in units of their tolerances: met from -1 to 1; empty: no value
  bool over = false;           // end the search: targets met, or limit reached
};

/// Evaluate a point: coordinates in [0, 1]; keys.
using Evaluate = std::function<Evaluation(const std::vector<double>&)>;

/// Evaluate points until `evaluate` reports `over` or no nearby point is better (steps below 1e-4). Starts at `start`;
/// with a single target at the bounds. A point without a value counts as worse than all others.
void search_targets(const std::vector<double>& start, std::size_t targets, const Evaluate& evaluate);

/// Largest absolute miss; infinite without a value.
double worst_miss(const std::vector<double>& misses);

}  // namespace plica
