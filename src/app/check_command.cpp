#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <optional>
#include <thread>

#include "app/options.hpp"
#include "app/progress.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/threads.hpp"
#include "core/words.hpp"
#include "record/time_left.hpp"
#include "scenario/advice.hpp"
#include "scenario/print.hpp"
#include "simulation/simulation.hpp"
#include "study/run_study.hpp"

namespace plica {
namespace {

// Read the study in a file; empty for a scenario or a missing file.
std::optional<StudyInput> study_in(const ScenarioOptions& options) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(options.name_or_path, error)) return {};
  if (!is_study(read_file(options.name_or_path))) return {};
  if (!options.overrides.empty())
    throw UsageError("--set: not available for a study; write the key into [set] of " + options.name_or_path);
  return read_study(options.name_or_path);
}

std::string bytes_text(double bytes) {
  if (bytes < 1e6) return fmt::format("{:.0f} kB", std::max(1.0, bytes / 1e3));
  return bytes < 1e9 ? fmt::format("{:.0f} MB", bytes / 1e6) : fmt::format("{:.1f} GB", bytes / 1e9);
}

void check_study(const StudyInput& input, int threads) {
  const ThreadCount count(std::max(1, threads));
  const Study study(input);
  for (const Diagnostic& note : study.notes()) fmt::print(stderr, "note: {}\n", note.text());
  fmt::print(stderr, "running the first point to estimate the cost (Ctrl-C skips this)\n");
  catch_interruptions();
  const StudyForecast found = forecast(study, interrupted);
  fmt::print("{}: {}, {} of {}\n", study.input().name, plural(found.points, "point"), plural(found.runs, "run"),
             input.scenario.name);
  for (const std::string& key : study.design().keys) fmt::print("  varies {}\n", key);
  for (const std::string& name : study.measures()) fmt::print("  measures {}\n", name);
  if (!found.refused.empty())
    fmt::print("{} invalid; each has status refused in the table; the first:\n  {}\n",
               found.refused.size() == 1 ? "1 point is" : fmt::format("{} points are", found.refused.size()),
               found.refused.front());
  if (found.first.status.empty()) return;
  const auto cores = std::max(1U, std::thread::hardware_concurrency());
  const auto runs = static_cast<double>(found.runs - found.refused.size() * found.runs / found.points);
  fmt::print("point {}: {} after {} steps, in {}; estimate for all runs: {} on {}, {} on disk\n",
             study.design().runs[found.first_run].point, found.first.status, found.first.steps,
             duration(found.first.wall_s), duration(found.first.wall_s * runs / cores), plural(cores, "core"),
             bytes_text(found.bytes_a_run * runs));
}

// Note how long a run takes: by its work, and by what that of ten steps, or of those within three seconds, takes here.
void estimate_time(Simulation simulation, const std::optional<WorkCurve>& curve) {
  constexpr double enough_s = 3, too_long_s = 10;
  const LiveLine clock(true);
  simulation.stop_when([&] { return clock.elapsed_s() > too_long_s; });
  double work = 0;
  while (simulation.steps() < 10 && clock.elapsed_s() < enough_s && simulation.step()) {
    const Observation& row = simulation.measures();
    work += work_of_step(row["newton_iterations"], row["linear_iterations"]);
  }
  if (work == 0) return;
  const auto [least, most] = expected_work(simulation.controls(), curve);
  const double unit_s = clock.elapsed_s() / work;
  const std::string from = about(unit_s * least), to = about(unit_s * most);
  fmt::print(stderr, "note: a run takes {}\n",
             from == to ? to : fmt::format("between {} and {}, very roughly", from, to));
}

}  // namespace

void add_check_command(CLI::App& app, int&) {
  CLI::App* command = app.add_subcommand(
      "check", "validate a scenario or study and estimate its cost; print a scenario with all defaults");
  auto options = std::make_shared<ScenarioOptions>();
  auto threads = std::make_shared<int>(0);
  options->add_to(*command);
  add_threads_option(*command, *threads);
  command->footer("Example: plica check my.toml --set embryo.elements_per_cell=[2,2,2]");
  command->callback([options, threads] {
    if (const std::optional<StudyInput> study = study_in(*options)) return check_study(*study, *threads);
    const Scenario scenario = options->load();
    std::optional<DelayedNotice> notice(std::in_place);
    Simulation simulation(scenario);
    notice.reset();
    use_threads(*threads, simulation.model().tissue.elements.size(), options->name_or_path);
    fmt::print("{}", resolved_toml(scenario));
    for (const std::string& line : advice(scenario, simulation.model())) fmt::print(stderr, "{}\n", line);
    estimate_time(std::move(simulation), builtin_curve(scenario));
  });
}

}  // namespace plica
