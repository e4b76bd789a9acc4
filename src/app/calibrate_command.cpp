#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "app/python_module.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/words.hpp"
#include "scenario/setup.hpp"
#include "study/calibrate.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

constexpr const char* of_gradients = "With --method gradient";  // group of options

struct CalibrateOptions {
  ScenarioOptions scenario;
  std::string method = "search";
  std::vector<std::string> vary, targets;
  std::string out;
  int trials = 40, threads = 0;
  bool overwrite = false;
};

// Check --out before the runs rather than after.
void refuse_out(const CalibrateOptions& options, const ScenarioSource& source) {
  if (options.out.empty()) return;
  std::error_code error;
  if (fs::equivalent(options.out, source.file, error))
    throw UsageError("--out " + options.out + ": is the scenario itself; give another name");
  require_new(options.out, {".toml"}, options.overwrite);
  if (fs::path folder = fs::absolute(options.out).parent_path(); !fs::is_directory(folder, error))
    throw FileError(options.out + ": its folder does not exist; create it, or give another --out");
}

// Deviation of the found value, relative to the target unless that is 0.
std::string miss_text(const Target& target, double found) {
  if (target.value == 0) return fmt::format("{:+.3g}", found);
  return fmt::format("{:+.2f} %", 100 * (found - target.value) / std::abs(target.value));
}

std::string values_text(const CalibrationProblem& problem, const std::vector<double>& values) {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < values.size(); ++k)
    texts.push_back(fmt::format("{} = {}", problem.keys[k].key, values[k]));
  return fmt::format("{}", fmt::join(texts, ", "));
}

std::string results_text(const CalibrationProblem& problem, const Trial& trial) {
  std::vector<std::string> texts;
  for (std::size_t t = 0; t < problem.targets.size(); ++t) {
    const Target& target = problem.targets[t];
    if (trial.found[t])
      texts.push_back(
          fmt::format("{} = {:.6g} ({})", target.name, *trial.found[t], miss_text(target, *trial.found[t])));
  }
  return fmt::format("{}", fmt::join(texts, ", "));
}

// Table with one row per trial; on a terminal also a live line for the trial under way.
class TrialTable {
 public:
  explicit TrialTable(const CalibrationProblem& problem) : problem_(problem) {}

  void show_progress(int number, const std::vector<double>& values, const Observation& row) {
    if (!line_.is_on_terminal()) return;
    line_.show(fmt::format("{:>5}  {}: t = {}", number, values_text(problem_, values), moment(row.time_s())));
  }

  void add(const Trial& trial, bool best) {
    line_.erase();
    if (trial.number == 1) fmt::print("{}\n", header());
    std::string line = fmt::format("{:>5}", trial.number);
    for (std::size_t k = 0; k < problem_.keys.size(); ++k)
      line += fmt::format("  {:>{}}", trial.values[k], width(problem_.keys[k].key));
    for (std::size_t t = 0; t < problem_.targets.size(); ++t) {
      const Target& target = problem_.targets[t];
      const std::optional<double> found = trial.found[t];
      line += fmt::format("  {:>{}}  {:>10}", found ? fmt::format("{:.6g}", *found) : "none", width(target.name),
                          found ? miss_text(target, *found) : "none");
    }
    line += fmt::format("  {:>6.1f}  {}", trial.wall_s, trial.worst_miss <= 1 ? "met" : best ? "best so far" : "");
    fmt::print("{}{}\n", line.substr(0, line.find_last_not_of(' ') + 1),
               trial.failure.empty() ? "" : "  no value: " + trial.failure);
    std::fflush(stdout);
  }

  void end_progress() const { line_.erase(); }

 private:
  static std::size_t width(const std::string& name) { return std::max<std::size_t>(name.size(), 9); }

  [[nodiscard]] std::string header() const {
    std::string line = "trial";
    for (const VariedKey& key : problem_.keys) line += fmt::format("  {:>{}}", key.key, width(key.key));
    for (const Target& target : problem_.targets)
      line += fmt::format("  {:>{}}  {:>10}", target.name, width(target.name), "deviation");
    return line + "   run s";
  }

  const CalibrationProblem& problem_;
  LiveLine line_{false};
};

CalibrationProblem problem_of(const CalibrateOptions& options) {
  CalibrationProblem problem{
      find_scenario(options.scenario.name_or_path), options.scenario.overrides, {}, {}, options.trials};
  for (const std::string& text : options.vary) problem.keys.push_back(parse_varied_key(text));
  for (const std::string& text : options.targets) problem.targets.push_back(parse_target(text));
  return problem;
}

// Print why the targets were not met, and the best trial.
void print_missed(const CalibrationProblem& problem, const Calibration& calibration) {
  if (calibration.end == CalibrationEnd::met) return;
  const std::string runs = plural(calibration.trials, "run");
  const std::string why = calibration.end == CalibrationEnd::not_met
                              ? fmt::format("not met: no values within the bounds meet all targets ({})", runs)
                          : calibration.end == CalibrationEnd::trials_spent
                              ? fmt::format("not met in {}; allow more --trials, or narrow the bounds", runs)
                              : fmt::format("interrupted after {}", runs);
  fmt::print(stderr, "plica: {}\n", why);
  if (!calibration.best) {
    fmt::print(stderr, "plica: no run has values of all targets\n");
    return;
  }
  fmt::print(stderr, "  best: {}\n", values_text(problem, calibration.best->values));
  fmt::print(stderr, "  results: {}\n", results_text(problem, *calibration.best));
  for (std::size_t k = 0; k < problem.keys.size(); ++k) {
    const VariedKey& key = problem.keys[k];
    const double value = calibration.best->values[k];
    const bool at_bound = value == key.low || value == key.high;
    if (calibration.end == CalibrationEnd::not_met && at_bound)
      fmt::print(stderr, "  {} is at its bound {}; widen the bounds\n", key.key, value);
  }
}

int exit_status(CalibrationEnd end) {
  if (end == CalibrationEnd::interrupted) return interrupted_status();
  return end == CalibrationEnd::met ? exit_done : exit_missed;
}

int calibrate_scenario(const CalibrateOptions& options) {
  const CalibrationProblem problem = problem_of(options);
  refuse_out(options, problem.source);
  const auto model = make_model(load_scenario(problem.source, problem.overrides));
  use_threads(options.threads, model->tissue.elements.size(), problem.source.file);
  TrialTable table(problem);
  catch_interruptions();
  const Calibration calibration =
      calibrate(problem, {interrupted,
                          [&](int number, const std::vector<double>& values, const Observation& row) {
                            table.show_progress(number, values, row);
                          },
                          [&](const Trial& trial, bool best) { table.add(trial, best); }});
  table.end_progress();
  if (calibration.end == CalibrationEnd::met)
    fmt::print("Met in {}: {}\n", plural(calibration.trials, "run"), values_text(problem, calibration.best->values));
  print_missed(problem, calibration);
  if (calibration.best && !options.out.empty()) {
    write_file(options.out, calibrated_toml(problem, calibration, options.out));
    fmt::print("{} in {}\n", calibration.end == CalibrationEnd::met ? "The scenario is" : "The best scenario is",
               options.out);
  }
  return exit_status(calibration.end);
}

// The method by gradients is that of the Python package (docs/decisions/0016-calibration.md): pass it all options.
int calibrate_by_gradients(const CLI::App& command) {
  std::vector<std::string> words = {"calibrate"};
  for (const CLI::Option* option : command.get_options()) {
    const std::string name = option->get_name();
    for (const std::string& given : option->results())
      if (option->get_positional())
        words.push_back(given);
      else if (option->get_items_expected_max() == 0)
        words.push_back(name);
      else if (name != "--method")
        words.push_back(name + "=" + given);
  }
  return become_module("calibrate --method gradient", "plica", words, "plica");
}

int calibrate_by(const CLI::App& command, const CalibrateOptions& options) {
  if (options.method == "gradient") return calibrate_by_gradients(command);
  for (const CLI::Option* option : command.get_options())
    if (option->get_group() == of_gradients && option->count() > 0)
      throw UsageError(option->get_name() + ": needs --method gradient; set it, or remove this option");
  if (options.targets.empty()) throw UsageError("no target; give --target");
  return calibrate_scenario(options);
}

void add_options_of_gradients(CLI::App& command) {
  const auto add = [&](const char* name, const char* type, const std::string& meaning) {
    return command.add_option(name, meaning)->type_name(type)->group(of_gradients);
  };
  add("--targets", "TEXT", "FILE.csv with columns outcome, value, sd, at_min, scenario");
  add("--prior", "TEXT", "KEY=VALUE~SD: normal prior of a key; repeatable")->take_all()->allow_extra_args(false);
  add("--starts", "INT", "number of starts (1)");
  add("--early-min", "FLOAT", "fit targets until this minute first");
  add("--folder", "TEXT", "folder for runs, so that the same command continues, and results");
}

}  // namespace

void add_calibrate_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("calibrate", "fit keys of a scenario to targets");
  auto options = std::make_shared<CalibrateOptions>();
  options->scenario.add_to(*command);
  command
      ->add_option("--method", options->method,
                   "search: without slopes (default); gradient: by slopes of runs (Python)")
      ->check(CLI::IsMember({"search", "gradient"}));
  command->add_option("--vary", options->vary, "KEY=LOW:HIGH: key to fit, with bounds; repeatable")
      ->required()
      ->allow_extra_args(false);
  command
      ->add_option(
          "--target", options->targets,
          "NAME=VALUE[~WITHIN]: target for a number of summary.json; WITHIN in its unit or as 2% (default: 0.5%); "
          "repeatable. By gradients also at a time, NAME@MIN")
      ->allow_extra_args(false);
  add_out_option(*command, options->out, "FILE.toml to write: the fitted scenario");
  command->add_option("--trials", options->trials, "maximum number of runs (40)")->check(CLI::Range(1, 100000));
  add_threads_option(*command, options->threads);
  command->add_flag("--overwrite", options->overwrite, "replace an existing file");
  add_options_of_gradients(*command);
  command->footer(
      "Example: plica calibrate drosophila --vary contraction.apical.stiffness_nN_per_um=3:7 --target "
      "furrow_depth_um=28.89~0.1 --out mine.toml");
  command->callback([command, options, &status] { status = calibrate_by(*command, *options); });
}

}  // namespace plica
