#include "study/calibrate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/errors.hpp"
#include "study/quiet_run.hpp"
#include "study/target_search.hpp"

namespace plica {
namespace {

// Trials of one calibration, made at the points that the search requests.
class Trials {
 public:
  Trials(const CalibrationProblem& problem, const CalibrationHooks& hooks) : problem_(problem), hooks_(hooks) {}

  Look look_at(const std::vector<double>& place) {
    const std::vector<double> values = values_at(problem_, place);
    const auto same = [&](const Trial& trial) { return trial.values == values; };
    const auto before = std::ranges::find_if(trials_, same);
    if (before != trials_.end()) return {misses(*before), false};
    if (trials_.size() >= static_cast<std::size_t>(problem_.most_trials)) return finish(CalibrationEnd::trials_spent);
    Trial trial = make(values);
    if (interrupted_) return finish(CalibrationEnd::interrupted);
    const bool is_best =
        std::isfinite(trial.worst_miss) && !(result_.best && result_.best->worst_miss <= trial.worst_miss);
    if (is_best) result_.best = trial;
    result_.trials = trial.number;
    trials_.push_back(trial);
    if (hooks_.on_trial) hooks_.on_trial(trial, is_best);
    if (trial.worst_miss <= 1) result_.end = CalibrationEnd::met;
    return {misses(trial), trial.worst_miss <= 1};
  }

  [[nodiscard]] const Calibration& result() const { return result_; }

 private:
  Look finish(CalibrationEnd end) {
    result_.end = end;
    return {{}, true};
  }

  Trial make(const std::vector<double>& values) {
    const auto start = std::chrono::steady_clock::now();
    Trial trial;
    trial.number = static_cast<int>(trials_.size()) + 1;
    trial.values = values;
    trial.found.resize(problem_.targets.size());
    QuietRunHooks run_hooks{hooks_.stop_requested, {}};
    if (hooks_.on_row) run_hooks.on_row = [&](const Observation& row) { hooks_.on_row(trial.number, values, row); };
    try {
      read(quiet_run(load_trial(problem_, values), run_hooks).summary, trial);
    } catch (const ScenarioError& error) {  // incompatible values
      trial.failure = error.what();
    }
    const auto misses_of_all = misses(trial);
    trial.worst_miss = worst_miss(misses_of_all);
    trial.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return trial;
  }

  void read(const nlohmann::ordered_json& summary, Trial& trial) {
    interrupted_ = summary.at("status") == "interrupted";
    if (summary.at("status") == "failed") {
      trial.failure = summary.at("failure").is_string() ? summary.at("failure").get<std::string>() : "solver failed";
      return;
    }
    for (std::size_t t = 0; t < problem_.targets.size(); ++t) {
      const auto& value = summary.at(problem_.targets[t].name);
      if (value.is_number()) trial.found[t] = value.get<double>();
      if (!trial.found[t] && trial.failure.empty())
        trial.failure = fmt::format("{} has no value", problem_.targets[t].name);
    }
  }

  // Deviations in units of the tolerances; empty if a target has no value.
  [[nodiscard]] std::vector<double> misses(const Trial& trial) const {
    std::vector<double> all;
    if (!trial.failure.empty()) return all;
    for (std::size_t t = 0; t < problem_.targets.size(); ++t)
      all.push_back((*trial.found[t] - problem_.targets[t].value) / problem_.targets[t].within);
    return all;
  }

  const CalibrationProblem& problem_;
  const CalibrationHooks& hooks_;
  std::vector<Trial> trials_;
  Calibration result_;
  bool interrupted_ = false;
};

}  // namespace

Calibration calibrate(const CalibrationProblem& problem, const CalibrationHooks& hooks) {
  check_calibration(problem);
  Trials trials(problem, hooks);
  search_targets(first_place(problem), problem.targets.size(),
                 [&](const std::vector<double>& place) { return trials.look_at(place); });
  return trials.result();
}

}  // namespace plica
