// Everything that a run leaves in its directory, written while it goes on. Files appear whole or not at all.
//
// series.csv and lineage.csv grow at once. A frame (its file, cells.csv, midline.csv, cross_section.csv, what listeners
// make of it) is taken from the state at once and then compressed and written beside the computation, and after it the
// step's checkpoint. What one step leaves is written before the next step is recorded.
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

  /// Of a simulation at rest, of which it then hears (Simulation::listen). Writes nothing: `begin` or `go_on` does.
  /// `start`: from when wall time counts.
  Recorder(std::filesystem::path directory, const Scenario& scenario, const Simulation& simulation,
           Clock::time_point start = Clock::now());

  /// `listener` outlives the recorder and hears of everything that is written from now on.
  void listen(RecordListener& listener) { listeners_.push_back(&listener); }

  /// Writes both scenario files (`input_toml`: as given), the frame at rest and the first checkpoint.
  void begin(const std::string& input_toml);

  /// After the simulation has gone on from a checkpoint: cuts every file back to what that knows of, and removes what a
  /// killed run has left half written. FileError when one is missing or too short.
  void go_on(const std::string& input_toml, RecordMemory memory);

  /// A row of series.csv, a frame when one is due, and the checkpoint. Throws what went wrong with the writing of an
  /// earlier step.
  void step_accepted(const AcceptedStep& step, const Observation& measures) override;

  /// A frame that shows the daughters, and their lines in lineage.csv.
  void cells_divided(const Division& division) override;

  /// The last frame, summary.json, and what listeners add.
  nlohmann::ordered_json finish();

  /// Whether a frame could not be written; the next call throws the reason.
  [[nodiscard]] bool has_failed() const { return writing_.has_failed(); }

 private:
  struct StepRecord;  // what a step leaves to be written
  [[nodiscard]] std::shared_ptr<StepRecord> step_record() const;
  [[nodiscard]] WallTimes wall() const;
  void open_tables(const RecordMemory& memory);
  void append_series(const Observation& row);
  void append_lineage(const Division& division);
  void save_frame();
  void write(const FrameRecord& frame);
  void write(const StepRecord& step);
  void tell(const Frame& frame, double time_s);

  std::filesystem::path directory_;
  const Scenario& scenario_;
  const Simulation& simulation_;
  Clock::time_point start_;
  double earlier_s_ = 0;  // wall time before `start`, of a run that went on
  double beside_s_ = 0;   // processor time that writing took from the steps, where there is one processor only
  double written_s_ = 0;  // and that it had taken when the last step had been recorded
  FrameTaker frame_taker_;
  std::optional<RowFile> series_, lineage_;
  std::vector<Observation> rows_;
  double last_frame_s_ = 0;

  // Of `write`, while frames are being written.
  std::optional<RowFile> midline_, section_, cells_;
  std::vector<std::pair<double, std::string>> frames_;  // time, file
  Checkpoint checkpoint_;                               // the last one, but for the run's memory
  CheckpointFiles checkpoints_;
  std::vector<RecordListener*> listeners_;
  Background writing_;  // the last member: it ends before what it writes with
};

}  // namespace plica
