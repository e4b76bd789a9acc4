// Simulation with a directory for its results, checkpoints and report.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/files.hpp"
#include "record/recorder.hpp"
#include "scenario/load.hpp"

namespace plica {

/// Recorded run. Locks the directory against other writers; simulation and scenario must outlive it.
///
///   RecordedRun record("results", scenario, source, simulation, RecordedRun::Start::fresh);
///   record.begin();
///   simulation.run();
///   record.finish();
class RecordedRun {
 public:
  enum class Start {
    fresh,   // the directory contains no results
    over,    // existing results are removed
    resumed  // continues from its checkpoint; starts without one
  };

  /// Check the directory without writing. The simulation must be in its reference state or, unless resumed, at any time
  /// before the first division, where rows start then. Throws UsageError if files would replace input of the run, or
  /// the checkpoint is of another run; FileError if the directory is not usable.
  RecordedRun(std::filesystem::path out, const Scenario& scenario, const ScenarioSource& source, Simulation& simulation,
              Start start, Recorder::Clock::time_point since = Recorder::Clock::now());
  RecordedRun(const RecordedRun&) = delete;
  RecordedRun& operator=(const RecordedRun&) = delete;
  ~RecordedRun();

  /// Whether a resumed run is already complete; do not call `begin` then.
  [[nodiscard]] bool is_finished() const { return is_finished_; }
  /// Notes for the user about the checkpoint.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Write the initial files, or restore simulation and files from the checkpoint, and record steps from now on.
  /// Returns true if it continues from a checkpoint.
  bool begin();

  /// Whether writing failed; the next step or `finish` throws the reason.
  [[nodiscard]] bool has_failed() const { return recorder_->has_failed(); }

  /// Write the last snapshot, summary.json and the report; later steps are not recorded.
  nlohmann::ordered_json finish();

 private:
  void look_for_checkpoint(const Scenario& scenario);

  std::filesystem::path out_;
  std::string input_toml_;
  Simulation& simulation_;
  bool is_finished_ = false;
  std::vector<std::string> notes_;
  std::unique_ptr<DirectoryLock> lock_;
  std::optional<Checkpoint> checkpoint_;
  std::unique_ptr<RecordListener> report_;
  std::unique_ptr<Recorder> recorder_;
};

/// Run a scenario in a directory to its end or until `stop`, continuing an unfinished run; a finished one is left
/// unchanged. Returns the summary. Throws as RecordedRun does.
nlohmann::ordered_json run_recorded(const std::filesystem::path& out, const Scenario& scenario,
                                    const ScenarioSource& source, const std::function<bool()>& stop);

}  // namespace plica
