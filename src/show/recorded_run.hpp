// A simulation and the directory that it leaves everything in: results, checkpoints, report.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/directory_lock.hpp"
#include "record/recorder.hpp"
#include "scenario/load.hpp"
#include "show/report_writer.hpp"

namespace plica {

/// Holds the directory, so that nobody else writes there. The simulation and the scenario outlive it.
///
///   RecordedRun record("results", scenario, source, simulation, RecordedRun::Start::fresh);
///   record.begin();
///   simulation.run();
///   record.finish();
class RecordedRun {
 public:
  enum class Start {
    fresh,   // the directory holds no results
    over,    // those that it holds are removed
    resumed  // goes on from its checkpoint; begins where there is none
  };

  /// Finds out whether that can be done, and writes nothing. The simulation is at rest or, if `start` is not resumed,
  /// at any moment before cells have divided: then rows begin there. UsageError when its files would replace what the
  /// run reads, or the checkpoint is of another run; FileError when the directory cannot be used.
  RecordedRun(std::filesystem::path out, const Scenario& scenario, const ScenarioSource& source, Simulation& simulation,
              Start start, Recorder::Clock::time_point since = Recorder::Clock::now());
  RecordedRun(const RecordedRun&) = delete;
  RecordedRun& operator=(const RecordedRun&) = delete;
  ~RecordedRun();

  /// Resumed, with nothing left to do: `begin` is not to be called.
  [[nodiscard]] bool is_finished() const { return is_finished_; }
  /// What was odd about the checkpoint, for the user to read.
  [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }

  /// Writes what stands before the first step, or brings simulation and files to where the checkpoint is. From now on
  /// steps are recorded. True when it went on from a checkpoint.
  bool begin();

  /// Whether a file could not be written; the next step, or `finish`, throws the reason.
  [[nodiscard]] bool has_failed() const { return recorder_->has_failed(); }

  /// The last frame, summary.json, the report. Steps that follow are not recorded.
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
  ReportWriter report_;
  std::unique_ptr<Recorder> recorder_;
};

/// Runs a scenario into a directory of its own, to its end or until `stop`; goes on with what was begun there, and with
/// what has ended does nothing. The summary. Errors as above.
nlohmann::ordered_json run_recorded(const std::filesystem::path& out, const Scenario& scenario,
                                    const ScenarioSource& source, const std::function<bool()>& stop);

}  // namespace plica
