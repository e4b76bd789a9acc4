#include <fmt/format.h>

#include <memory>
#include <new>
#include <optional>
#include <stdexcept>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "core/errors.hpp"
#include "core/units.hpp"
#include "core/words.hpp"
#include "record/archive.hpp"
#include "record/results.hpp"
#include "record/time_left.hpp"
#include "scenario/advice.hpp"
#include "show/recorded_run.hpp"
#include "show/report.hpp"
#include "simulation/run_warnings.hpp"

namespace plica {
namespace {

struct RunOptions {
  ScenarioOptions scenario;
  std::string out;
  int threads = 0;
  bool quiet = false, overwrite = false, resume = false;
};

void print_result(const Scenario& scenario, const nlohmann::ordered_json& summary, const std::string& out) {
  const std::string criterion = summary.at("stopped_by").is_string() && summary.at("stopped_by") != "equilibrium"
                                    ? fmt::format(" (stopped by {})", summary.at("stopped_by").get<std::string>())
                                    : "";
  fmt::print("{}: {}{} at {} after {} step{} in {:.1f} s\n", summary.at("scenario").get<std::string>(),
             summary.at("status").get<std::string>(), criterion, moment(summary.at("time_s").get<double>()),
             summary.at("steps").get<int>(), summary.at("steps") == 1 ? "" : "s", summary.at("wall_s").get<double>());
  fmt::print("  {}\n", summary.at("outcome").get<std::string>());
  if (const std::string crossing = crossing_text(scenario, summary); !crossing.empty()) fmt::print("  {}\n", crossing);
  fmt::print("  results in {0}{1}\n", out, can_report() ? fmt::format("; open {}/report.html in a browser", out) : "");
}

int exit_status(RunStatus status, bool missed) {
  if (status == RunStatus::failed) return exit_gave_up;
  if (status == RunStatus::under_way) return interrupted_status();
  return missed ? exit_missed : exit_done;
}

// Time that a step under way at an interruption is given to finish. Docker and Slurm wait at least 10 s before they
// kill.
constexpr double step_patience_s = 3;

// Run to the end, or until an interruption.
nlohmann::ordered_json simulate(const Scenario& scenario, Simulation& simulation, RecordedRun& record,
                                const std::optional<WorkCurve>& curve, bool quiet) {
  Progress progress({simulation.controls(), curve, simulation.time_s()}, quiet);
  simulation.stop_when([&] { return interrupted_for(step_patience_s) || record.has_failed(); });
  bool has_crossed = false;
  while (simulation.step()) {
    if (!has_crossed && simulation.measures()["self_intersections"] > 0) {
      has_crossed = true;
      progress.finish();
      fmt::print(stderr, "warning: {}\n", crossing_warning(scenario, simulation));
    }
    progress.show(simulation.measures());
    if (interrupted()) break;
  }
  progress.finish();
  return record.finish();
}

// Add to errors of a run under way how to resume it: nothing accepted is lost.
template <class Work>
auto with_a_way_on(const Work& work) {
  const std::string way_on = can_archive() ? "; correct the cause and repeat the command with --resume" : "";
  try {
    return work();
  } catch (const FileError& error) {
    throw FileError(error.what() + way_on);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("out of memory" + way_on);
  }
}

void report_ending(const Scenario& scenario, const Simulation& simulation, const nlohmann::ordered_json& summary,
                   const std::vector<std::string>& missed, const RunOptions& options) {
  for (const std::string& line : missed) fmt::print(stderr, "{}\n", line);
  if (!simulation.failure().empty())
    fmt::print(
        stderr,
        "plica: solver failed: {0}; last accepted state saved in {1}; view it with: plica render {1} --time last --out "
        "last.png\n",
        simulation.failure(), options.out);
  for (const auto& [topic, text] : summary.at("warnings").items())
    fmt::print(stderr, "warning: {}\n", text.get<std::string>());
  if (simulation.status() == RunStatus::under_way && can_archive())
    fmt::print(stderr, "plica: interrupted; to continue, repeat the command with --resume\n");
  if (!options.quiet) print_result(scenario, summary, options.out);
}

int run_scenario(const RunOptions& options) {
  const Recorder::Clock::time_point start = Recorder::Clock::now();
  const ScenarioSource source = find_scenario(options.scenario.name_or_path);
  const Scenario loaded = load_scenario(source, options.scenario.overrides);
  const Scenario scenario = options.resume ? as_begun(loaded, options.out) : loaded;
  std::optional<DelayedNotice> notice;
  if (!options.quiet) notice.emplace();
  Simulation simulation(scenario);
  notice.reset();
  use_threads(options.threads, simulation.model().tissue.elements.size(), options.scenario.name_or_path);

  if (!options.quiet && !options.resume)  // a resumed run has shown them
    for (const std::string& line : advice(scenario, simulation.model()))
      if (line.starts_with("warning")) fmt::print(stderr, "{}\n", line);

  RecordedRun record(options.out, scenario, source, simulation,
                     start_of<RecordedRun::Start>(options.resume, options.overwrite), start);
  for (const std::string& note : record.notes()) fmt::print(stderr, "plica: {}\n", note);
  if (record.is_finished()) {
    if (!options.quiet) fmt::print("{}: the run is already complete\n", options.out);
    return exit_done;
  }
  catch_interruptions();
  // Before they are overwritten.
  std::optional<WorkCurve> curve = curve_of_run(options.out, scenario);
  if (!curve) curve = builtin_curve(scenario);
  const nlohmann::ordered_json summary = with_a_way_on([&] {
    if (record.begin() && !options.quiet)
      fmt::print("resuming after step {}, t = {:g} s\n", simulation.steps(), simulation.time_s());
    return simulate(scenario, simulation, record, curve, options.quiet);
  });
  std::vector<std::string> missed;
  if (simulation.status() == RunStatus::equilibrium || simulation.status() == RunStatus::end_time)
    missed = missed_expectations(scenario, summary);
  report_ending(scenario, simulation, summary, missed, options);
  return exit_status(simulation.status(), !missed.empty());
}

}  // namespace

void add_run_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("run", "run a scenario");
  auto options = std::make_shared<RunOptions>();
  options->scenario.add_to(*command);
  add_out_option(*command, options->out, "directory for the results")->required();
  add_threads_option(*command, options->threads);
  command->add_flag("--quiet", options->quiet, "print only warnings and errors");
  auto* overwrite = command->add_flag("--overwrite", options->overwrite, "replace the results in DIR");
  command->add_flag("--resume", options->resume, "continue from the checkpoint in DIR; without one, start")
      ->excludes(overwrite);
  command->footer("Example: plica run drosophila --out results --set contraction.apical.across_ratio=1");
  command->callback([options, &status] { status = run_scenario(*options); });
}

}  // namespace plica
