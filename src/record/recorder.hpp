// Everything that a run leaves in its directory, written while it goes on. Files appear whole or not at all.
//
// series.csv and lineage.csv grow at once. A frame (its file, cells.csv, midline.csv, what listeners make of it) is
// taken from the state at once and then compressed and written beside the computation, and after it the step's
// checkpoint. What one step leaves is written before the next step is recorded.
#pragma once

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

namespace plica {

class Recorder {
 public:
  /// Of a model at rest. Writes nothing: `begin` or `go_on` does.
  Recorder(std::filesystem::path directory, const Scenario& scenario, const Model& model, const Observer& observer);

  /// `listener` outlives the recorder and hears of everything that is written from now on.
  void listen(RecordListener& listener) { listeners_.push_back(&listener); }

  /// Writes both scenario files (`input_toml`: as given), the frame at rest and the first checkpoint.
  void begin(const std::string& input_toml, const RunMemory& at_rest);

  /// Cuts every file back to what the checkpoint knows of, and removes what a killed run has left half written.
  /// FileError when one is missing or too short.
  void go_on(const std::string& input_toml, RecordMemory memory);

  /// A row of series.csv, a frame when one is due, and the checkpoint. Returns the row. Throws what went wrong with the
  /// writing of an earlier step.
  const Observation& record(const AcceptedStep& step, const WallTimes& wall = {});

  /// After one of the past divisions has been made again.
  void follow_division() { frame_taker_.follow_division(); }

  /// A frame that shows the daughters, and their lines in lineage.csv.
  void record_division(const Division& division, const State& state);

  /// The last frame, summary.json, and what listeners add.
  nlohmann::ordered_json finish(const RunResult& result, const WallTimes& wall);

  /// Whether a frame could not be written; the next call throws the reason.
  [[nodiscard]] bool has_failed() const { return writing_.has_failed(); }

  /// Processor time that writing beside the computation has taken so far, s.
  [[nodiscard]] double writing_s() { return writing_.processor_s(); }

  [[nodiscard]] const std::vector<Observation>& rows() const { return rows_; }

 private:
  struct StepRecord;  // what a step leaves to be written
  [[nodiscard]] std::shared_ptr<StepRecord> step_record(RunMemory run, const WallTimes& wall) const;
  void open_tables(const RecordMemory& memory);
  void append_series(const Observation& row);
  void append_lineage(const Division& division);
  void save_frame(const State& state);
  void write(const FrameRecord& frame);
  void write(const StepRecord& step);
  void tell(const Frame& frame, double time_s);

  std::filesystem::path directory_;
  const Scenario& scenario_;
  const Model& model_;
  const Observer& observer_;
  FrameTaker frame_taker_;
  std::optional<RowFile> series_, lineage_;
  std::vector<Observation> rows_;
  double last_frame_s_ = 0;

  // Of `write`, while frames are being written.
  std::optional<RowFile> midline_, cells_;
  std::vector<std::pair<double, std::string>> frames_;  // time, file
  Checkpoint checkpoint_;                               // the last one, but for the run's memory
  CheckpointFiles checkpoints_;
  std::vector<RecordListener*> listeners_;
  Background writing_;  // the last member: it ends before what it writes with
};

}  // namespace plica
