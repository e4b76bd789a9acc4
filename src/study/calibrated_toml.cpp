// Scenario written by a calibration: short, readable, and loaded once to verify that it equals what was run.
#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <filesystem>

#include "core/errors.hpp"
#include "scenario/builtin.hpp"
#include "scenario/print.hpp"
#include "scenario/schema.hpp"
#include "study/calibrate.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

// Value of `base` in `file` that refers to the scenario.
std::string base_of(const ScenarioSource& source, const std::string& file) {
  for (const BuiltinScenario& builtin : builtin_scenarios())
    if (builtin.name == source.file) return source.file;
  return fs::proximate(fs::absolute(source.file), fs::absolute(file).parent_path()).generic_string();
}

// Convert "key=word" of the command line to a line of TOML.
std::string line_of(const std::string& override) {
  const std::size_t equals = override.find('=');
  const std::string key = override.substr(0, equals), value = override.substr(equals + 1);
  try {
    (void)toml::parse("v = " + value);
    return fmt::format("{} = {}\n", key, value);
  } catch (const toml::parse_error&) {  // a bare word
    return fmt::format("{} = {}\n", key, in_toml(value));
  }
}

std::string comment(const CalibrationProblem& problem, const Calibration& calibration) {
  std::string text = fmt::format("# {} by plica calibrate in {} run{}.\n",
                                 calibration.end == CalibrationEnd::met ? "Calibrated" : "Best result found",
                                 calibration.trials, calibration.trials == 1 ? "" : "s");
  for (const VariedKey& key : problem.keys)
    text += fmt::format("# Varied: {} from {} to {}.\n", key.key, key.low, key.high);
  for (std::size_t t = 0; t < problem.targets.size(); ++t) {
    const Target& target = problem.targets[t];
    text += fmt::format("# Target: {} = {} within {:.4g}; result {:.6g}.\n", target.name, target.value, target.within,
                        *calibration.best->found[t]);
  }
  return text;
}

// Targets that [expect] accepts: its own names and monitors.
std::string expectations(const CalibrationProblem& problem) {
  std::string text;
  for (const Target& target : problem.targets)
    if (std::ranges::count(expectation_names(), target.name) > 0 || target.name.find('.') != std::string::npos)
      text += fmt::format("expect.{} = {{ value = {}, within = {} }}\n", target.name, target.value, target.within);
  return text;
}

bool loads_as(const ScenarioSource& source, const Scenario& wanted) {
  try {
    return resolved_toml(load_scenario(source)) == resolved_toml(wanted);
  } catch (const ScenarioError&) {
    return false;
  }
}

}  // namespace

std::string calibrated_toml(const CalibrationProblem& problem, const Calibration& calibration,
                            const std::string& file) {
  const std::vector<double>& values = calibration.best->values;
  const Scenario calibrated = load_trial(problem, values);
  std::string text = fmt::format("format = 1\nbase = {}\n", in_toml(base_of(problem.source, file)));
  for (const std::string& override : trial_overrides(problem, values)) text += line_of(override);
  const std::string head = comment(problem, calibration);
  if (!loads_as({calibrated.name, file, text}, calibrated)) return head + resolved_toml(calibrated);
  return head + text + (calibration.end == CalibrationEnd::met ? expectations(problem) : "");
}

}  // namespace plica
