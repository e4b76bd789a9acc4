#include "study/calibrate.hpp"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlopt.hpp>
#include <set>
#include <string_view>

#include "core/errors.hpp"
#include "core/numbers.hpp"
#include "core/words.hpp"
#include "scenario/builtin.hpp"
#include "scenario/print.hpp"
#include "scenario/schema.hpp"
#include "scenario/setup.hpp"
#include "scenario/toml_reader.hpp"
#include "study/quiet_run.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

constexpr double usual_percent = 0.5;

constexpr double smallest_step = 1e-4;  // where the search has converged
constexpr double smallest_bracket = 1e-8;
constexpr double first_step = 0.2;
constexpr double better = 0.98;      // relative to the best miss so far
constexpr std::size_t patience = 4;  // evaluations without improvement, times n + 1
constexpr double penalty = 2;        // of a point without a value, relative to the worst miss so far
constexpr double unknown = 1e3;      // worst miss before any is known

// Evaluate points and record what both searches need.
class Evaluator {
 public:
  Evaluator(std::vector<double> start, std::size_t targets, const Evaluate& evaluate)
      : best_(std::move(start)), targets_(targets), evaluate_(evaluate) {}

  const Evaluation& at(const std::vector<double>& place) {
    if (place == place_) return last_;
    place_ = place;
    last_ = evaluate_(place);
    const double miss = worst_miss(last_.misses);
    since_better_ = miss < better * best_miss_ ? 0 : since_better_ + 1;
    if (miss < best_miss_) best_miss_ = miss, best_ = place;
    if (!last_.misses.empty()) worst_miss_ = std::max(worst_miss_, miss);
    return last_;
  }

  [[nodiscard]] std::vector<double> misses_or_penalty() const {
    if (!last_.misses.empty()) return last_.misses;
    return std::vector<double>(targets_, worst_miss_ > 0 ? penalty * worst_miss_ : unknown);
  }

  [[nodiscard]] const std::vector<double>& best() const { return best_; }
  [[nodiscard]] bool over() const { return last_.over; }
  /// Whether no recent evaluation improved notably on all earlier ones.
  [[nodiscard]] bool gets_nowhere() const { return since_better_ > patience * (best_.size() + 1); }

 private:
  std::vector<double> best_, place_;
  std::size_t targets_;
  const Evaluate& evaluate_;
  Evaluation last_;
  std::size_t since_better_ = 0;
  double best_miss_ = std::numeric_limits<double>::infinity(), worst_miss_ = 0;  // of evaluations with a value
};

// Search between the bounds. Returns true if they bracket the target and every point had a value: the search is
// complete.
bool search_bracket(Evaluator& evaluator) {
  bool all_have_values = true;
  const auto miss = [&](double place) {
    const Evaluation& evaluation = evaluator.at({place});
    all_have_values = all_have_values && !evaluation.misses.empty();
    return evaluation.over || evaluation.misses.empty() ? 0.0 : evaluation.misses.front();  // 0 ends the search
  };
  const double low = miss(0), high = evaluator.over() ? 0 : miss(1);
  if (evaluator.over()) return true;
  if (!all_have_values || low * high > 0) return false;
  std::uintmax_t most = 100;
  const auto narrow = [](double a, double b) { return std::abs(b - a) < smallest_bracket; };
  boost::math::tools::toms748_solve(miss, 0.0, 1.0, low, high, narrow, most);
  return evaluator.over() || all_have_values;
}

// A miss is an equation, m = 0, given as two inequalities, since NLopt allows at most as many equations as coordinates.
void misses_for_nlopt(unsigned count, double* at_most_0, unsigned dimension, const double* place, double*, void* data) {
  Evaluator& evaluator = *static_cast<Evaluator*>(data);
  evaluator.at({place, place + dimension});
  if (evaluator.over() || evaluator.gets_nowhere()) throw nlopt::forced_stop();
  const std::vector<double> misses = evaluator.misses_or_penalty();
  for (unsigned i = 0; i < count; ++i) at_most_0[i] = i % 2 == 0 ? misses[i / 2] : -misses[i / 2];
}

double nothing_to_minimise(unsigned, const double*, double*, void*) { return 0; }

void search_linear_models(Evaluator& evaluator, std::size_t targets) {
  std::vector<double> place = evaluator.best();
  nlopt::opt search(nlopt::LN_COBYLA, static_cast<unsigned>(place.size()));
  search.set_lower_bounds(0);
  search.set_upper_bounds(1);
  search.set_min_objective(nothing_to_minimise, nullptr);
  search.add_inequality_mconstraint(misses_for_nlopt, &evaluator, std::vector<double>(2 * targets, 0));
  search.set_initial_step(first_step);
  search.set_xtol_abs(smallest_step);
  try {
    double unused = 0;
    search.optimize(place, unused);
  } catch (const nlopt::forced_stop&) {       // finished, or nowhere to go
  } catch (const nlopt::roundoff_limited&) {  // improvements are below rounding error
  }
}

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

// Deviations in units of the tolerances; empty if a target has no value.
std::vector<double> misses(const CalibrationProblem& problem, const Trial& trial) {
  std::vector<double> all;
  if (!trial.failure.empty()) return all;
  for (std::size_t t = 0; t < problem.targets.size(); ++t)
    all.push_back((*trial.found[t] - problem.targets[t].value) / problem.targets[t].within);
  return all;
}

void read_results(const CalibrationProblem& problem, const nlohmann::ordered_json& summary, Trial& trial) {
  if (summary.at("status") == "failed")
    trial.failure = summary.at("failure").is_string() ? summary.at("failure").get<std::string>() : "solver failed";
  for (std::size_t t = 0; t < problem.targets.size() && summary.at("status") != "failed"; ++t) {
    const auto& value = summary.at(problem.targets[t].name);
    if (value.is_number())
      trial.found[t] = value.get<double>();
    else if (trial.failure.empty())
      trial.failure = fmt::format("{} has no value", problem.targets[t].name);
  }
}

// Run the scenario with these values; empty if interrupted.
std::optional<Trial> make_trial(const CalibrationProblem& problem, const CalibrationHooks& hooks, int number,
                                const std::vector<double>& values) {
  const auto start = std::chrono::steady_clock::now();
  Trial trial;
  trial.number = number;
  trial.values = values;
  trial.found.resize(problem.targets.size());
  QuietRunHooks of_run{hooks.stop_requested};
  if (hooks.on_row) of_run.on_row = [&](const Observation& row) { hooks.on_row(number, values, row); };
  try {
    const nlohmann::ordered_json summary = quiet_run(load_trial(problem, values), of_run).summary;
    if (summary.at("status") == "interrupted") return {};
    read_results(problem, summary, trial);
  } catch (const ScenarioError& error) {  // incompatible values
    trial.failure = error.what();
  }
  trial.worst_miss = worst_miss(misses(problem, trial));
  trial.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return trial;
}

// Value of `base` in `file` that refers to the scenario.
std::string base_of(const ScenarioSource& source, const std::string& file) {
  for (const BuiltinScenario& builtin : builtin_scenarios())
    if (builtin.name == source.file) return source.file;
  return fs::proximate(fs::absolute(source.file), fs::absolute(file).parent_path()).generic_string();
}

// Convert "key=word" of the command line to a line of TOML.
std::string line_of(const std::string& override) {
  const std::size_t equals = override.find('=');
  return fmt::format("{} = {}\n", override.substr(0, equals), word_in_toml(override.substr(equals + 1)));
}

std::string comment(const CalibrationProblem& problem, const Calibration& calibration) {
  std::string text = fmt::format("# {} by plica calibrate in {}.\n",
                                 calibration.end == CalibrationEnd::met ? "Calibrated" : "Best result found",
                                 plural(calibration.trials, "run"));
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

double worst_miss(const std::vector<double>& misses) {
  if (misses.empty()) return std::numeric_limits<double>::infinity();
  double worst = 0;
  for (const double miss : misses) worst = std::max(worst, std::abs(miss));
  return worst;
}

void search_targets(const std::vector<double>& start, std::size_t targets, const Evaluate& evaluate) {
  Evaluator evaluator(start, targets, evaluate);
  if (start.size() == 1 && targets == 1 && search_bracket(evaluator)) return;
  if (!evaluator.over()) search_linear_models(evaluator, targets);
}

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

Calibration calibrate(const CalibrationProblem& problem, const CalibrationHooks& hooks) {
  check_calibration(problem);
  Calibration result;
  std::vector<Trial> trials;
  const auto evaluate = [&](const std::vector<double>& place) -> Evaluation {
    const std::vector<double> values = values_at(problem, place);
    const auto before = std::ranges::find(trials, values, &Trial::values);
    if (before != trials.end()) return {misses(problem, *before), false};
    const auto finish = [&](CalibrationEnd end) -> Evaluation {
      result.end = end;
      return {{}, true};
    };
    if (result.trials >= problem.most_trials) return finish(CalibrationEnd::trials_spent);
    const std::optional<Trial> trial = make_trial(problem, hooks, result.trials + 1, values);
    if (!trial) return finish(CalibrationEnd::interrupted);
    const bool is_best =
        std::isfinite(trial->worst_miss) && !(result.best && result.best->worst_miss <= trial->worst_miss);
    if (is_best) result.best = trial;
    result.trials = trial->number;
    trials.push_back(*trial);
    if (hooks.on_trial) hooks.on_trial(*trial, is_best);
    if (trial->worst_miss <= 1) result.end = CalibrationEnd::met;
    return {misses(problem, *trial), trial->worst_miss <= 1};
  };
  search_targets(first_place(problem), problem.targets.size(), evaluate);
  return result;
}

// Short and readable; loaded once to verify that it equals what was run.
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
