#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <new>
#include <stdexcept>

#include "app/commands.hpp"
#include "app/interruption.hpp"
#include "app/progress.hpp"
#include "app/scenario_options.hpp"
#include "app/threads.hpp"
#include "core/directory_lock.hpp"
#include "core/errors.hpp"
#include "core/units.hpp"
#include "core/version.hpp"
#include "measure/self_intersections.hpp"
#include "record/archive.hpp"
#include "record/recorder.hpp"
#include "record/run_directory.hpp"
#include "scenario/advice.hpp"
#include "scenario/print.hpp"
#include "show/report.hpp"
#include "show/report_writer.hpp"

namespace plica {
namespace {

struct RunOptions {
  ScenarioOptions scenario;
  std::string out;
  int threads = 0;
  bool quiet = false, overwrite = false, resume = false;
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
  const nlohmann::ordered_json &closed_s = summary.at("lips_closed_time_s"), &closed = summary.at("lips_closed");
  const std::string lips = closed.is_null() ? ""
                           : closed_s.is_number()
                               ? fmt::format(", lips {} at {:.2f} min", closed == 1 ? "closed" : "open again, closed",
                                             closed_s.get<double>() / units::minute)
                               : ", lips open";
  fmt::print("  furrow depth {}, apical area ratio {} (VML), peak speed ratio {}{}\n", value("furrow_depth_um", " um"),
             value("vml_apical_area_ratio", ""), value("peak_speed_ratio", ""), lips);
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

int exit_status(RunStatus status, bool missed) {
  if (status == RunStatus::failed) return exit_gave_up;
  if (status == RunStatus::under_way) return interrupted_status();
  return missed ? exit_missed : exit_done;
}

// A step under way at an interruption is finished if it can be within this. What ends processes (Docker, Slurm) waits
// for 10 s and more.
constexpr double step_patience_s = 3;

// A tissue that passes through itself is a tissue no more: said once, with place and time, also with --quiet.
std::string crossing_warning(const Simulation& simulation) {
  const Tissue& tissue = simulation.model().tissue;
  const Vectors& positions = simulation.state().positions;
  for (const auto& [side, facets] : {std::pair("apical", &tissue.apical_facets), {"basal", &tissue.basal_facets}}) {
    const auto pairs = crossing_facets(*facets, positions);
    if (pairs.empty()) continue;
    const Facet &one = (*facets)[pairs.front().first], &other = (*facets)[pairs.front().second];
    Vec3 place = Vec3::Zero();
    for (const NodeId node : one.nodes) place += positions[node.index()] / 4;
    const auto id = [&](const Facet& facet) { return tissue.cells[facet.cell.index()].lineage.id; };
    return fmt::format(
        "warning: the tissue passes through itself: at t = {:.4g} min the {} faces of cells {} and {} cross, at x = "
        "{:.1f}, y = {:.1f}, z = {:.1f} um ({} pairs in all); what comes after is no tissue any more{}\n",
        simulation.time_s() / units::minute, side, id(one), id(other), place.x(), place.y(), place.z(), pairs.size(),
        simulation.measures()["contact_pairs"] ? "" : "; [self_contact] would hold it off");
  }
  return "";
}

// The checkpoint in the directory `out`; nothing: begin. UsageError when it is of another run; FileError when it is
// damaged, or when there are results that belong to none.
std::optional<Checkpoint> checkpoint_to_resume(const std::string& out, const Scenario& scenario, const Model& at_rest) {
  if (!can_archive()) throw UsageError("this plica was built without HDF5: it has no checkpoints to resume from");
  std::string complaint;
  std::optional<Checkpoint> checkpoint = read_checkpoint(out, complaint);
  if (!complaint.empty()) fmt::print(stderr, "plica: {}; going on from the checkpoint before it\n", complaint);
  if (!checkpoint) {
    if (holds_steps(out))
      throw FileError(out + ": holds results without a checkpoint; begin anew with --overwrite, or give another --out");
    return std::nullopt;
  }
  const std::string now = resolved_toml(scenario);
  if (const auto other = other_scenario(checkpoint->scenario, now))
    throw UsageError(
        fmt::format("{}: the checkpoint is of another scenario: {}; only [time], [stop] and [output] may change: give "
                    "another --out",
                    out, *other));
  if (checkpoint->at_rest != fingerprint(at_rest.tissue))
    throw UsageError(fmt::format("{}: the checkpoint is of another embryo ({}; this one has {}); has its mesh changed?",
                                 out, checkpoint->at_rest, fingerprint(at_rest.tissue)));
  if (checkpoint->program != version())
    fmt::print(stderr, "plica: {} was written by version {}; what follows may differ from it in the last digits\n", out,
               checkpoint->program);
  // What ended the run may not end it any more: the next step is asked.
  if (other_stop(checkpoint->scenario, now)) checkpoint->run.criterion_met = checkpoint->run.at_equilibrium = false;
  return checkpoint;
}

// Brings simulation and recorder from rest to where the checkpoint is.
void go_on_from(Checkpoint checkpoint, const std::string& out, Simulation& simulation, Recorder& recorder,
                const std::string& input_toml) {
  try {
    simulation.go_on_from(std::move(checkpoint.run), checkpoint.record.rows.back());
  } catch (const UnfitMemory& error) {
    throw FileError(out + ": the checkpoint is damaged: " + error.what());
  }
  recorder.go_on(input_toml, std::move(checkpoint.record));
}

// To the end, or an interruption.
nlohmann::ordered_json simulate(Simulation& simulation, Recorder& recorder, bool quiet) {
  Progress progress(simulation.controls(), quiet);
  simulation.listen(recorder);
  simulation.stop_when([&] { return interrupted_for(step_patience_s) || recorder.has_failed(); });
  bool has_crossed = false;
  while (simulation.step()) {
    if (!has_crossed && simulation.measures()["self_intersections"] > 0) {
      has_crossed = true;
      progress.finish();
      fmt::print(stderr, "{}", crossing_warning(simulation));
    }
    progress.show(simulation.measures());
    if (interrupted()) break;
  }
  progress.finish();
  return recorder.finish();
}

// Once a run has begun, what ends it can be mended, and nothing is lost.
template <class Work>
auto with_a_way_on(const Work& work) {
  const std::string way_on = can_archive() ? "; once there is a remedy, the same command with --resume goes on" : "";
  try {
    return work();
  } catch (const FileError& error) {
    throw FileError(error.what() + way_on);
  } catch (const std::bad_alloc&) {
    throw std::runtime_error("out of memory" + way_on);
  }
}

void report_ending(const Simulation& simulation, const nlohmann::ordered_json& summary,
                   const std::vector<std::string>& missed, const RunOptions& options) {
  for (const std::string& line : missed) fmt::print(stderr, "{}\n", line);
  if (!simulation.failure().empty())
    fmt::print(
        stderr,
        "plica: gave up: {0}; the last good state is in {1}, seen by: plica render {1} --time last --out last.png\n",
        simulation.failure(), options.out);
  if (simulation.status() == RunStatus::under_way && can_archive())
    fmt::print(stderr, "plica: interrupted; to go on, give the same command with --resume\n");
  if (!options.quiet) print_result(summary, options.out);
}

int run_scenario(const RunOptions& options) {
  const Recorder::Clock::time_point start = Recorder::Clock::now();
  const ScenarioSource source = find_scenario(options.scenario.name_or_path);
  const Scenario scenario = load_scenario(source, options.scenario.overrides);
  Simulation simulation(scenario);
  use_threads(options.threads, simulation.model().tissue.elements.size(), options.scenario.name_or_path);

  if (!options.quiet)
    for (const std::string& line : advice(scenario, simulation.model()))
      if (line.starts_with("warning")) fmt::print(stderr, "{}\n", line);

  refuse_to_replace_scenario(source.file, options.out);
  refuse_to_replace_reference(simulation.observer().monitors(), options.out);
  auto lock = std::make_unique<DirectoryLock>(options.out);
  std::optional<Checkpoint> checkpoint;
  if (options.resume) checkpoint = checkpoint_to_resume(options.out, scenario, simulation.model());
  if (checkpoint && has_ended(checkpoint->run, simulation.controls()) && holds_ending(options.out, can_report())) {
    if (!options.quiet) fmt::print("{}: the run is finished; nothing is left to do\n", options.out);
    return exit_done;
  }
  if (!checkpoint) {
    prepare_directory(options.out, options.overwrite || options.resume);
    lock.reset();
    lock = std::make_unique<DirectoryLock>(options.out);  // it may have been made only now
  }
  catch_interruptions();
  ReportWriter report(options.out);
  Recorder recorder(options.out, scenario, simulation, start);
  if (can_report()) recorder.listen(report);
  const nlohmann::ordered_json summary = with_a_way_on([&] {
    if (checkpoint) {
      go_on_from(std::move(*checkpoint), options.out, simulation, recorder, source.text);
      if (!options.quiet) fmt::print("going on after step {}, t = {:g} s\n", simulation.steps(), simulation.time_s());
    } else {
      recorder.begin(source.text);
    }
    return simulate(simulation, recorder, options.quiet);
  });
  std::vector<std::string> missed;
  if (simulation.status() == RunStatus::equilibrium || simulation.status() == RunStatus::end_time)
    missed = missed_expectations(scenario, summary);
  report_ending(simulation, summary, missed, options);
  return exit_status(simulation.status(), !missed.empty());
}

}  // namespace

void add_run_command(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("run", "run a scenario");
  auto options = std::make_shared<RunOptions>();
  options->scenario.add_to(*command);
  command->add_option("--out,--output,-o", options->out, "directory for the results")->required();
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
