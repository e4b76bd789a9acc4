// Recorder of a run: writes all files of its directory while it proceeds, each atomically.
//
// series.csv grows immediately. A snapshot (its file, cells.csv, midline.csv, cross_section.csv, output of listeners)
// is copied from the state, then compressed and written in the background, followed by the checkpoint if the step is
// resumable. The output of one step is written before the next step is recorded.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/background.hpp"
#include "core/files.hpp"
#include "measure/observation.hpp"
#include "record/checkpoint.hpp"
#include "record/frame_record.hpp"
#include "record/summary.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// Observer of recorded output, for example a report or a live view.
class RecordListener {
 public:
  virtual ~RecordListener() = default;

  /// Called for each written snapshot in order of time, on the writing thread; on resumption also for earlier ones.
  virtual void add_frame(const Frame& frame, double time_s) = 0;

  /// Called at the end of the run, when all files exist.
  virtual void end() = 0;
};

class Recorder final : public SimulationListener {
 public:
  using Clock = std::chrono::steady_clock;

  /// `simulation`: in its reference state, with this recorder as listener. `start`: start of wall time. Writes nothing
  /// before `begin` or `go_on`.
  Recorder(std::filesystem::path directory, const Scenario& scenario, const Simulation& simulation,
           Clock::time_point start = Clock::now());

  /// Register an observer of everything written from now on; it must outlive the recorder.
  void listen(RecordListener& listener) { listeners_.push_back(&listener); }

  /// Write both scenario files (`input_toml`: as given), the reference snapshot and the first checkpoint.
  void begin(const std::string& input_toml);

  /// Continue after a checkpoint, from which the simulation continues: truncate every file to its recorded size, remove
  /// incomplete files and read the rows of the series. Throws FileError for a missing, short or damaged file.
  void go_on(const std::string& input_toml, RecordMemory memory);

  /// Record a row of series.csv, and a snapshot and a checkpoint if due. Rethrows write errors of earlier steps.
  void step_accepted(const AcceptedStep& step, const Observation& measures) override;

  /// Record a snapshot with the daughters and their rows of lineage.csv.
  void cells_divided(const TissueChange& change) override;

  /// Write the last snapshot, summary.json and the output of listeners; returns the summary.
  nlohmann::ordered_json finish();

  /// Whether writing failed; the next call throws the reason.
  [[nodiscard]] bool has_failed() const { return writing_.has_failed(); }

 private:
  void save_checkpoint();
  [[nodiscard]] WallTimes wall() const;
  void open_tables(const RecordMemory& memory);
  void append(const std::string& table, const std::string& rows);
  void record_row();
  void save_frame();
  void write(const FrameRecord& frame);
  void write(Checkpoint& checkpoint);  // completed by what is written before it
  void list_frames();                  // in frames.pvd
  void tell(const Frame& frame, double time_s);

  std::filesystem::path directory_;
  const Scenario& scenario_;
  const Simulation& simulation_;
  Clock::time_point start_;
  double earlier_s_ = 0;  // wall time before `start` of a resumed run
  double beside_s_ = 0;   // processor time that writing took from the steps on a single processor
  double written_s_ = 0;  // its value when the last step was recorded
  FrameTaker frame_taker_;
  Checkpoint blank_;  // without a step
  std::vector<Observation> rows_;
  double last_frame_s_ = 0;

  // Used in the background, or while nothing is written there.
  std::map<std::string, RowFile> tables_;               // by file name
  std::vector<std::pair<double, std::string>> frames_;  // time, file
  Clock::time_point listed_;                            // when they were listed
  CheckpointFiles checkpoints_;
  std::vector<RecordListener*> listeners_;
  Background writing_;  // last member: destroyed first, since it uses the others
};

}  // namespace plica
