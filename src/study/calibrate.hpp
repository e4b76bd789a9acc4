// Calibration: which values of some keys of a scenario make its results meet given targets.
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
  std::vector<std::optional<double>> found;  // targets; empty: has no value
  std::string failure;                       // why there is no value; empty where all have one
  double worst_miss = 0;                     // largest |found - value| / within; infinite with a failure
  double wall_s = 0;
};

enum class CalibrationEnd {
  met,
  not_met,       // no better place nearby: the targets cannot be met within the bounds, as far as the search sees
  trials_spent,  // most_trials runs were made
  interrupted,
};

struct Calibration {
  CalibrationEnd end = CalibrationEnd::not_met;
  std::optional<Trial> best;  // the one with the smallest worst miss; empty where none had a value
  int trials = 0;
};

struct CalibrationHooks {
  std::function<bool()> stop_requested = {};
  std::function<void(int trial, const std::vector<double>& values, const Observation&)> on_row = {};  // while it runs
  std::function<void(const Trial&, bool best_so_far)> on_trial = {};
};

/// Runs the scenario, one trial after another, where the search of target_search.hpp asks for it. Checks the problem
/// first (check_calibration), and throws as that does.
Calibration calibrate(const CalibrationProblem& problem, const CalibrationHooks& hooks = {});

/// The best trial's scenario, to be saved as `file`: the problem's scenario as its base, then overrides and values, the
/// targets under [expect] where all were met, and what was calibrated as a comment. The scenario in full where one with
/// a base would not come to the same.
std::string calibrated_toml(const CalibrationProblem& problem, const Calibration& calibration, const std::string& file);

}  // namespace plica
