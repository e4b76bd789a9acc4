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
#include "core/version.hpp"
#include "output/archive.hpp"
#include "output/checkpoint.hpp"
#include "output/recorder.hpp"
#include "output/report.hpp"
#include "scenario/advice.hpp"
#include "scenario/print.hpp"
#include "scenario/setup.hpp"
#include "scenario/watch.hpp"

namespace plica {
namespace {

struct RunOptions {
  ScenarioOptions scenario;
  std::string out;
  int threads = 0;
  bool quiet = false, overwrite = false, resume = false;
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

/// What there is to go on from in the directory of --out; nothing: begin. Refuses what is of another run.
std::optional<Checkpoint> checkpoint_to_resume(const RunOptions& options, const Scenario& scenario,
                                               const Model& at_rest) {
  if (!can_archive()) throw UsageError("this plica was built without HDF5: it has no checkpoints to resume from");
  std::string complaint;
  std::optional<Checkpoint> checkpoint = read_checkpoint(options.out, complaint);
  if (!complaint.empty()) fmt::print(stderr, "plica: {}; going on from the checkpoint before it\n", complaint);
  if (!checkpoint) {
    if (std::filesystem::exists(std::filesystem::path(options.out) / "summary.json"))
      throw FileError(options.out + ": holds results without a checkpoint; begin anew with --overwrite");
    return std::nullopt;
  }
  if (const auto other = other_scenario(checkpoint->scenario, resolved_toml(scenario)))
    throw UsageError(
        fmt::format("{}: the checkpoint is of another scenario: {}. Only [time], [stop] and [output] may change; give "
                    "another --out",
                    options.out, *other));
  if (checkpoint->at_rest != fingerprint(at_rest.tissue))
    throw UsageError(fmt::format("{}: the checkpoint is of another embryo ({}; this one has {}); has its mesh changed?",
                                 options.out, checkpoint->at_rest, fingerprint(at_rest.tissue)));
  if (checkpoint->program != version())
    fmt::print(stderr, "plica: {} was written by version {}; what follows may differ from it in the last digits\n",
               options.out, checkpoint->program);
  return checkpoint;
}

bool is_finished(const RunMemory& run, const RunControls& controls) {
  return run.criterion_met || (run.at_equilibrium && controls.stop_at_equilibrium) ||
         run.state.time_s >= controls.end_s * (1 - 1e-12);
}

/// Brings model, observer and recorder to where the checkpoint is.
RunMemory go_on_from(Checkpoint checkpoint, const RunOptions& options, Model& model, Observer& observer,
                     Recorder& recorder, const std::string& input_toml) {
  for (const auto& past : checkpoint.run.past_divisions) {
    if (const auto why = why_unfit(*past, model)) throw FileError(options.out + ": the checkpoint is damaged: " + *why);
    observer.follow_division(repeat(model, *past));
    recorder.follow_division();
  }
  if (const auto why = why_unfit(checkpoint, model))
    throw FileError(options.out + ": the checkpoint is damaged: " + *why);
  recorder.go_on(input_toml, std::move(checkpoint.record));
  return std::move(checkpoint.run);
}

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
  std::optional<Checkpoint> checkpoint;
  if (options.resume) checkpoint = checkpoint_to_resume(options, scenario, *model);
  if (checkpoint && is_finished(checkpoint->run, controls) &&
      std::filesystem::exists(std::filesystem::path(options.out) / "summary.json")) {
    if (!options.quiet) fmt::print("{}: the run is finished; nothing is left to do\n", options.out);
    return exit_done;
  }
  if (!checkpoint) prepare_directory(options.out, options.overwrite || options.resume);
  Recorder recorder(options.out, scenario, *model, observer);
  const WallTimes before = checkpoint ? WallTimes{checkpoint->record.wall_s, checkpoint->record.solver_s} : WallTimes{};
  RunMemory memory;
  if (checkpoint) {
    memory = go_on_from(std::move(*checkpoint), options, *model, observer, recorder, source.text);
  } else {
    memory.state = rest_state(*model);
    recorder.begin(source.text, memory.state);
  }
  Progress progress(controls, options.quiet);
  catch_interruptions();

  SolverClock solver_clock(recorder);
  const auto wall = [&] {
    return WallTimes{before.total_s + seconds_since(start), before.solver_s + solver_clock.solver_s()};
  };
  const RunResult result = run(
      *model, std::move(memory), controls,
      [&](const AcceptedStep& step) {
        solver_clock.stop();
        const Observation& row = recorder.record(step, wall());
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
  const auto summary = recorder.finish(result, wall());

  const std::vector<std::string> missed = result.status == RunStatus::failed || result.status == RunStatus::interrupted
                                              ? std::vector<std::string>{}
                                              : missed_expectations(scenario, summary);
  for (const std::string& line : missed) fmt::print(stderr, "{}\n", line);
  if (!result.failure.empty())
    fmt::print(stderr, "plica: gave up: {}; the last good state is in {}\n", result.failure, options.out);
  if (result.status == RunStatus::interrupted && can_archive())
    fmt::print(stderr, "plica: interrupted; to go on, give the same command with --resume\n");
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
  auto* overwrite = command->add_flag("--overwrite", options->overwrite, "replace the results in DIR");
  command->add_flag("--resume", options->resume, "go on from the checkpoint in DIR; begin where there is none")
      ->excludes(overwrite);
  command->footer("Example: plica run drosophila --out results --set contraction.apical.across_ratio=1");
  command->callback([options, &status] { status = run_scenario(*options); });
}

}  // namespace plica
