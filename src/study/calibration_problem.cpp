#include "study/calibration_problem.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string_view>

#include "core/errors.hpp"
#include "core/numbers.hpp"
#include "scenario/print.hpp"
#include "scenario/setup.hpp"
#include "scenario/suggest.hpp"
#include "study/quiet_run.hpp"

namespace plica {
namespace {

constexpr double usual_percent = 0.5;

// Round a value to a millionth of the bounds' width, so that it is short to write.
double value_at(const VariedKey& key, double place) {
  const int decimals = 6 - static_cast<int>(std::floor(std::log10(key.high - key.low)));
  const double value = key.low + place * (key.high - key.low);
  if (place <= 0 || place >= 1 || decimals < 0 || decimals > 300) return std::clamp(value, key.low, key.high);
  return std::clamp(*number_in(fmt::format("{:.{}f}", value, decimals)), key.low, key.high);
}

void refuse_impossible_numbers(const CalibrationProblem& problem) {
  if (problem.keys.empty() || problem.targets.empty())
    throw UsageError("nothing to calibrate; give at least one key to vary and one target");
  for (const auto& [key, low, high] : problem.keys)
    if (!std::isfinite(high - low) || !(low < high))
      throw UsageError(fmt::format("{}: bounds {} and {} are not increasing finite numbers; give the lower one first",
                                   key, low, high));
  for (const auto& [name, value, within] : problem.targets)
    if (!std::isfinite(value) || !std::isfinite(within) || !(within > 0))
      throw UsageError(
          fmt::format("{}: target {} with tolerance {}; give two numbers, the tolerance above 0", name, value, within));
  if (problem.most_trials < 1)
    throw UsageError(fmt::format("{} runs allowed; allow at least one", problem.most_trials));
}

void refuse_repetitions(const CalibrationProblem& problem) {
  std::set<std::string> keys, targets;
  for (const VariedKey& key : problem.keys) {
    if (!keys.insert(key.key).second) throw UsageError(fmt::format("--vary {}: occurs twice; remove one", key.key));
    for (const std::string& override : problem.overrides)
      if (override.substr(0, override.find_first_of(" =")) == key.key)
        throw UsageError(fmt::format("--vary {}: conflicts with --set of the same key; remove one", key.key));
  }
  for (const Target& target : problem.targets)
    if (!targets.insert(target.name).second)
      throw UsageError(fmt::format("--target {}: occurs twice; remove one", target.name));
}

void refuse_unknown_targets(const CalibrationProblem& problem, const std::vector<std::string>& known) {
  for (const Target& target : problem.targets) {
    if (std::ranges::count(known, target.name) > 0) continue;
    if (is_a_cost(target.name))
      throw UsageError(fmt::format("--target {}: a cost, which differs between runs; give a result", target.name));
    throw UsageError(
        fmt::format("--target {}: not a number of summary.json; {}", target.name, result_remedy(target.name, known)));
  }
}

}  // namespace

VariedKey parse_varied_key(const std::string& text) {
  const std::size_t equals = text.find('='), colon = text.find(':', equals == std::string::npos ? 0 : equals);
  if (equals == std::string::npos || equals == 0 || colon == std::string::npos)
    throw UsageError(fmt::format("--vary {}: not KEY=LOW:HIGH; give it in this form", text));
  const auto low = number_in(std::string_view(text).substr(equals + 1, colon - equals - 1));
  const auto high = number_in(std::string_view(text).substr(colon + 1));
  if (!low || !high) throw UsageError(fmt::format("--vary {}: a bound is not a number; give KEY=LOW:HIGH", text));
  const std::string key = text.substr(0, equals);
  if (*low == *high)
    throw UsageError(fmt::format("--vary {}: the bounds are equal; set the value with --set {}={}", text, key, *low));
  if (*low > *high)
    throw UsageError(fmt::format("--vary {}: low is above high; write {}={}:{}", text, key, *high, *low));
  return {key, *low, *high};
}

Target parse_target(const std::string& text) {
  const std::size_t equals = text.find('='), tilde = text.find('~', equals == std::string::npos ? 0 : equals);
  const std::string_view view(text);
  const auto value = equals == std::string::npos || equals == 0
                         ? std::nullopt
                         : number_in(view.substr(equals + 1, tilde == std::string::npos ? tilde : tilde - equals - 1));
  if (!value)
    throw UsageError(
        fmt::format("--target {}: unknown form; give NAME=VALUE, NAME=VALUE~WITHIN or NAME=VALUE~PERCENT%", text));
  Target target{text.substr(0, equals), *value, std::abs(*value) * usual_percent / 100};
  if (tilde == std::string::npos) {
    if (target.within == 0)
      throw UsageError(
          fmt::format("--target {}: a target of 0 needs an absolute tolerance; give {}=0~WITHIN", text, target.name));
    return target;
  }
  const bool percent = text.ends_with('%');
  const auto within = number_in(view.substr(tilde + 1, view.size() - tilde - 1 - (percent ? 1 : 0)));
  target.within = within ? (percent ? std::abs(*value) * *within / 100 : *within) : 0;
  if (!(target.within > 0))
    throw UsageError(fmt::format("--target {}: tolerance not above 0; give NAME=VALUE~0.1 or ~2%", text));
  return target;
}

std::vector<std::string> trial_overrides(const CalibrationProblem& problem, const std::vector<double>& values) {
  std::vector<std::string> overrides = problem.overrides;
  for (std::size_t k = 0; k < values.size(); ++k)
    overrides.push_back(fmt::format("{}={}", problem.keys[k].key, float_in_toml(values[k])));
  return overrides;
}

std::vector<double> values_at(const CalibrationProblem& problem, const std::vector<double>& place) {
  std::vector<double> values;
  for (std::size_t k = 0; k < place.size(); ++k) values.push_back(value_at(problem.keys[k], place[k]));
  return values;
}

std::vector<double> first_place(const CalibrationProblem& problem) {
  const toml::table resolved = toml::parse(resolved_toml(load_scenario(problem.source, problem.overrides)));
  std::vector<double> place;
  for (const VariedKey& key : problem.keys) {
    const auto own = toml::at_path(resolved, key.key).value<double>();
    const double coordinate = own ? (*own - key.low) / (key.high - key.low) : -1;
    place.push_back(coordinate >= 0 && coordinate <= 1 ? coordinate : 0.5);
  }
  return place;
}

Scenario load_trial(const CalibrationProblem& problem, const std::vector<double>& values) {
  try {
    return load_scenario(problem.source, trial_overrides(problem, values));
  } catch (const ScenarioError& error) {
    std::vector<Diagnostic> diagnostics = error.diagnostics();
    for (Diagnostic& diagnostic : diagnostics) {
      const auto is_it = [&](const VariedKey& key) { return key.key == diagnostic.key; };
      if (diagnostic.file != "--set" || std::ranges::none_of(problem.keys, is_it)) continue;
      diagnostic.file = "--vary";
      if (diagnostic.problem.ends_with("is not an integer"))
        diagnostic = {"--vary", 0, diagnostic.key, "is an integer",
                      "vary a real-valued key, and set this one with --set"};
    }
    throw ScenarioError(std::move(diagnostics));
  }
}

void check_calibration(const CalibrationProblem& problem) {
  refuse_impossible_numbers(problem);
  refuse_repetitions(problem);
  const std::vector<double> low(problem.keys.size(), 0), high(problem.keys.size(), 1);
  for (const auto& place : {low, high}) (void)make_model(load_trial(problem, values_at(problem, place)));
  refuse_unknown_targets(problem, result_names(run_at_rest(load_trial(problem, values_at(problem, low))).summary));
}

}  // namespace plica
