#include <fmt/format.h>
#include <omp.h>

#include <chrono>
#include <filesystem>
#include <memory>

#include "app/commands.hpp"
#include "app/interruption.hpp"
#include "app/progress.hpp"
#include "app/scenario_options.hpp"
#include "app/threads.hpp"
#include "core/errors.hpp"
#include "core/units.hpp"
#include "output/recorder.hpp"
#include "output/report.hpp"
#include "scenario/advice.hpp"
#include "scenario/setup.hpp"
#include "scenario/watch.hpp"

namespace plica {
namespace {

struct RunOptions {
  ScenarioOptions scenario;
  std::string out;
  int threads = 0;
  bool quiet = false, overwrite = false;
};

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Wall time of the solver: what passes while nothing is recorded, less what the writing of files beside it takes of
/// the core where there is only one.
class SolverClock {
 public:
  explicit SolverClock(Recorder& recorder) : recorder_(recorder) { start(); }
  void start() {
    start_ = std::chrono::steady_clock::now();
    writing_s_ = recorder_.writing_s();
  }
  void stop() {
    solver_s_ += seconds_since(start_);
    if (omp_get_num_procs() == 1) solver_s_ -= recorder_.writing_s() - writing_s_;
  }
  [[nodiscard]] double solver_s() const { return solver_s_; }

 private:
  Recorder& recorder_;
  std::chrono::steady_clock::time_point start_;
  double writing_s_ = 0, solver_s_ = 0;
};

void print_result(const nlohmann::ordered_json& summary, const std::string& out) {
  const auto value = [&](const char* key, const char* unit) {
    return summary.at(key).is_number() ? fmt::format("{:.2f}{}", summary.at(key).get<double>(), unit) : "none";
  };
  const std::string criterion = summary.at("stopped_by").is_string() && summary.at("stopped_by") != "equilibrium"
                                    ? fmt::format(" (stopped by {})", summary.at("stopped_by").get<std::string>())
                                    : "";
  fmt::print("{}: {}{} at {:.2f} min after {} steps in {:.1f} s\n", summary.at("scenario").get<std::string>(),
             summary.at("status").get<std::string>(), criterion, summary.at("time_s").get<double>() / units::minute,
             summary.at("steps").get<int>(), summary.at("wall_s").get<double>());
  fmt::print("  furrow depth {}, apical area ratio {} (VML), peak speed ratio {}\n", value("furrow_depth_um", " um"),
             value("vml_apical_area_ratio", ""), value("peak_speed_ratio", ""));
  fmt::print("  results in {0}{1}\n", out, can_report() ? fmt::format("; to look at: {}/report.html", out) : "");
}

// A scenario that lies in DIR under a name that plica writes there would be lost.
void refuse_to_replace_scenario(const std::string& scenario_file, const std::filesystem::path& out) {
  if (out.empty()) throw UsageError("--out is empty; give the directory for the results");
  std::error_code error;
  for (const char* name : {"scenario.toml", "scenario.input.toml"})
    if (std::filesystem::equivalent(scenario_file, out / name, error))
      throw UsageError(scenario_file + ": the results would replace it; give another --out, or move the scenario");
}

// Nor would there be anything to measure against.
void refuse_to_replace_reference(const std::vector<Monitor>& monitors, const std::filesystem::path& out) {
  std::error_code error;
  for (const Monitor& monitor : monitors)
    if (monitor.reference_run && std::filesystem::equivalent(monitor.reference_run->directory(), out, error))
      throw UsageError(
          fmt::format("--out {} is the reference of monitor \"{}\"; give another --out", out.string(), monitor.name));
}

int exit_status(const RunResult& result, bool missed) {
  if (result.status == RunStatus::failed) return exit_gave_up;
  if (result.status == RunStatus::interrupted) return interrupted_status();
  return missed ? exit_missed : exit_done;
}

int run_scenario(const RunOptions& options) {
  const auto start = std::chrono::steady_clock::now();
  const ScenarioSource source = find_scenario(options.scenario.name_or_path);
  const Scenario scenario = load_scenario(source, options.scenario.overrides);
  const auto model = make_model(scenario);
  omp_set_num_threads(threads_for(options.threads, model->tissue.elements.size()));
  const RunControls controls = make_controls(scenario, *model);
  Observer observer(*model, make_furrow_sites(scenario, model->tissue), make_watch(scenario, model->tissue));

  if (!options.quiet)
    for (const std::string& line : advice(scenario, *model))
      if (line.starts_with("warning")) fmt::print(stderr, "{}\n", line);

  refuse_to_replace_scenario(source.file, options.out);
  refuse_to_replace_reference(observer.monitors(), options.out);
  prepare_directory(options.out, options.overwrite);
  const State rest = rest_state(*model);
  Recorder recorder(options.out, scenario, source.text, *model, observer, rest);
  Progress progress(controls, options.quiet);
  catch_interruptions();

  SolverClock solver_clock(recorder);
  const auto run_start = std::chrono::steady_clock::now();
  const RunResult result = run(
      *model, rest, controls,
      [&](const AcceptedStep& step) {
        solver_clock.stop();
        const Observation& row = recorder.record(step, seconds_since(run_start));
        progress.show(row);
        solver_clock.start();
        return StepAnswer(!interrupted(), row.is_over);
      },
      [&] { return interrupted() || recorder.has_failed(); },
      [&](const Division& division, const State& state) {
        solver_clock.stop();
        observer.follow_division(division);
        recorder.record_division(division, state);
        solver_clock.start();
      });
  solver_clock.stop();
  progress.finish();
  const auto summary = recorder.finish(result, {seconds_since(start), solver_clock.solver_s()});

  const std::vector<std::string> missed = result.status == RunStatus::failed || result.status == RunStatus::interrupted
                                              ? std::vector<std::string>{}
                                              : missed_expectations(scenario, summary);
  for (const std::string& line : missed) fmt::print(stderr, "{}\n", line);
  if (!result.failure.empty())
    fmt::print(stderr, "plica: gave up: {}; the last good state is in {}\n", result.failure, options.out);
  if (!options.quiet) print_result(summary, options.out);
  return exit_status(result, !missed.empty());
}

}  // namespace

void add_run_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("run", "run a scenario");
  auto options = std::make_shared<RunOptions>();
  options->scenario.add_to(*command);
  command->add_option("--out", options->out, "directory for the results")->required();
  command->add_option("--threads", options->threads, "threads to use; results do not depend on it")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--quiet", options->quiet, "no progress and no result on the terminal");
  command->add_flag("--overwrite", options->overwrite, "replace the results in DIR");
  command->footer("Example: plica run drosophila --out results --set contraction.apical.across_ratio=1");
  command->callback([options, &status] { status = run_scenario(*options); });
}

}  // namespace plica
