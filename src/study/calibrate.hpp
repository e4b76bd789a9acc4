// Calibration: fit keys of a scenario to targets.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "measure/observation.hpp"
#include "study/calibration_problem.hpp"

namespace plica {

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

}  // namespace plica
