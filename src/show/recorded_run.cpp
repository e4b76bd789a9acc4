#include "show/recorded_run.hpp"

#include <fmt/format.h>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "record/archive.hpp"
#include "record/results.hpp"
#include "record/run_directory.hpp"
#include "scenario/print.hpp"
#include "show/report.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

// Protect the scenario's file, a study, and reference runs of monitors.
void refuse_to_replace_input(const std::string& scenario_file, const std::vector<Monitor>& monitors,
                             const fs::path& out) {
  if (out.empty()) throw UsageError("--out: empty; give the directory for the results");
  std::error_code error;
  for (const char* name : {"scenario.toml", "scenario.input.toml"})
    if (fs::equivalent(scenario_file, out / name, error))
      throw UsageError(scenario_file + ": would be replaced by the results; give another --out, or move the scenario");
  if (is_there(out / "study.json")) throw UsageError(out.string() + ": contains a study; give another --out");
  for (const Monitor& monitor : monitors)
    if (monitor.reference_run && fs::equivalent(monitor.reference_run->directory(), out, error))
      throw UsageError(
          fmt::format("--out {} is the reference of monitor \"{}\"; give another --out", out.string(), monitor.name));
}

// Writer of report.html at the end of a run.
class ReportWriter final : public RecordListener {
 public:
  explicit ReportWriter(fs::path directory) : directory_(std::move(directory)) {}
  void add_frame(const Frame& frame, double time_s) override { frames_.add(frame, time_s); }
  void end() override { write_file(directory_ / "report.html", report_page({make_report_run(directory_, frames_)})); }

 private:
  fs::path directory_;
  ReportFrames frames_{most_frame_bytes};
};

}  // namespace

RecordedRun::RecordedRun(fs::path out, const Scenario& scenario, const ScenarioSource& source, Simulation& simulation,
                         Start start, Recorder::Clock::time_point since)
    : out_(std::move(out)), input_toml_(source.text), simulation_(simulation) {
  refuse_to_replace_input(source.file, simulation.observer().monitors(), out_);
  if (simulation.divisions() > 0)
    throw UsageError("cells have already divided; start a record before the first division");
  if (start == Start::resumed && simulation.steps() > 0)
    throw UsageError("the simulation has already taken steps; resume a run with a new Simulation");
  lock_ = std::make_unique<DirectoryLock>(out_);
  if (start == Start::resumed) look_for_checkpoint(scenario);
  is_finished_ = checkpoint_ && has_ended(checkpoint_->run, simulation.controls()) && holds_ending(out_, can_report());
  if (is_finished_) return;
  if (!checkpoint_) {
    prepare_directory(out_, start != Start::fresh);
    lock_.reset();
    lock_ = std::make_unique<DirectoryLock>(out_);  // it may have been created just now
  }
  recorder_ = std::make_unique<Recorder>(out_, scenario, simulation, since);
  if (!can_report()) return;
  report_ = std::make_unique<ReportWriter>(out_);
  recorder_->listen(*report_);
}

RecordedRun::~RecordedRun() {
  if (recorder_) simulation_.stop_listening(*recorder_);
}

// Find a checkpoint. Throws UsageError for another run, FileError if it is damaged or results have none.
void RecordedRun::look_for_checkpoint(const Scenario& scenario) {
  if (!can_archive()) throw UsageError("--resume: not available (built without HDF5)");
  std::string complaint;
  checkpoint_ = read_checkpoint(out_, complaint);
  if (!complaint.empty()) notes_.push_back(complaint + "; continuing from the previous checkpoint");
  if (!checkpoint_) {
    if (holds_steps(out_))
      throw FileError(out_.string() +
                      ": contains results without a checkpoint; restart with --overwrite, or give another --out");
    return;
  }
  const std::string now = resolved_toml(scenario);
  if (const auto other = other_scenario(checkpoint_->scenario, now))
    throw UsageError(
        fmt::format("{}: the checkpoint is of another scenario ({}); change only [time], [stop] and [output], or give "
                    "another --out",
                    out_.string(), *other));
  const std::string at_rest = fingerprint(simulation_.model().tissue);
  if (checkpoint_->at_rest != at_rest)
    throw UsageError(
        fmt::format("{}: the checkpoint is of another mesh ({}; now {}); restore the mesh, or give another --out",
                    out_.string(), checkpoint_->at_rest, at_rest));
  if (checkpoint_->program != version())
    notes_.push_back(fmt::format("{} was written by version {}; further results may differ in the last digits",
                                 out_.string(), checkpoint_->program));
  // The criteria that ended the run may have changed; the next step evaluates them.
  if (other_stop(checkpoint_->scenario, now))
    checkpoint_->run.measures.is_over = checkpoint_->run.at_equilibrium = false;
}

bool RecordedRun::begin() {
  const bool goes_on = checkpoint_.has_value();
  if (goes_on) {
    try {
      simulation_.go_on_from(std::move(checkpoint_->run));
    } catch (const UnfitMemory& error) {
      throw FileError(out_.string() + ": the checkpoint is damaged: " + error.what());
    }
    recorder_->go_on(input_toml_, std::move(checkpoint_->record));
    checkpoint_.reset();
  } else {
    recorder_->begin(input_toml_);
  }
  simulation_.listen(*recorder_);
  return goes_on;
}

nlohmann::ordered_json RecordedRun::finish() {
  simulation_.stop_listening(*recorder_);
  return recorder_->finish();
}

nlohmann::ordered_json run_recorded(const fs::path& out, const Scenario& scenario, const ScenarioSource& source,
                                    const std::function<bool()>& stop) {
  const Scenario begun = as_begun(scenario, out);
  Simulation simulation(begun);
  RecordedRun record(out, begun, source, simulation, RecordedRun::Start::resumed);
  if (record.is_finished()) return read_summary(out);
  record.begin();
  simulation.stop_when([&] { return stop() || record.has_failed(); });
  while (!stop() && simulation.step()) {
  }
  return record.finish();
}

}  // namespace plica
