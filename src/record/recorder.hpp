// Recorder of a run: writes all files of its directory while it proceeds, each atomically.
//
// series.csv and lineage.csv grow immediately. A snapshot (its file, cells.csv, midline.csv, cross_section.csv, output
// of listeners) is copied from the state, then compressed and written in the background, followed by the checkpoint if
// the step is resumable. The output of one step is written before the next step is recorded.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/background.hpp"
#include "core/files.hpp"
#include "measure/observation.hpp"
#include "record/checkpoint_files.hpp"
#include "record/frame_record.hpp"
#include "record/record_listener.hpp"
#include "record/summary.hpp"
#include "scenario/scenario.hpp"
#include "simulation/simulation.hpp"

namespace plica {

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

  /// Continue after a checkpoint: truncate every file to its recorded size and remove incomplete files. Throws
  /// FileError for a missing or short file.
  void go_on(const std::string& input_toml, RecordMemory memory);

  /// Record a row of series.csv, and a snapshot and a checkpoint if due. Rethrows write errors of earlier steps.
  void step_accepted(const AcceptedStep& step, const Observation& measures) override;

  /// Record a snapshot with the daughters and their rows of lineage.csv.
  void cells_divided(const Division& division) override;

  /// Write the last snapshot, summary.json and the output of listeners; returns the summary.
  nlohmann::ordered_json finish();

  /// Whether writing failed; the next call throws the reason.
  [[nodiscard]] bool has_failed() const { return writing_.has_failed(); }

 private:
  void save_checkpoint();
  [[nodiscard]] WallTimes wall() const;
  void open_tables(const RecordMemory& memory);
  void append_series(const Observation& row);
  void append_lineage(const Division& division);
  void save_frame();
  void write(const FrameRecord& frame);
  void write(Checkpoint& checkpoint);  // completed by what is written before it
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
  std::optional<RowFile> series_, lineage_;
  std::vector<Observation> rows_;
  double last_frame_s_ = 0;

  // Used by `write`, in the background.
  std::optional<RowFile> midline_, section_, cells_;
  std::vector<std::pair<double, std::string>> frames_;  // time, file
  CheckpointFiles checkpoints_;
  std::vector<RecordListener*> listeners_;
  Background writing_;  // last member: destroyed first, since it uses the others
};

}  // namespace plica
