// Everything that a run leaves in its directory, written while it goes on. Files appear whole or not at all.
//
// series.csv and lineage.csv grow at once. A frame (its file, cells.csv, midline.csv, the report's share) is taken from
// the state at once and then compressed and written beside the computation, in order; three at most are in memory.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "core/background.hpp"
#include "core/files.hpp"
#include "measure/observation.hpp"
#include "output/frame_record.hpp"
#include "output/report_frames.hpp"
#include "output/summary.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Makes `directory` ready for results. Throws FileError when it cannot be made or written to, or when it holds results
/// and `overwrite` is false. With `overwrite`, removes the files that plica writes and nothing else.
void prepare_directory(const std::filesystem::path& directory, bool overwrite);

class Recorder {
 public:
  /// `input_toml` is the scenario as given. Writes both scenario files and the frame at rest.
  Recorder(std::filesystem::path directory, const Scenario& scenario, const std::string& input_toml, const Model& model,
           const Observer& observer, const State& rest);

  /// A row of series.csv, and a frame when one is due. Returns the row. `wall_s`: as of Observer::observe. Throws what
  /// went wrong with the writing of an earlier frame.
  const Observation& record(const AcceptedStep& step, double wall_s = 0);

  /// A frame that shows the daughters, and their lines in lineage.csv.
  void record_division(const Division& division, const State& state);

  /// The last frame, summary.json and report.html.
  nlohmann::ordered_json finish(const RunResult& result, const WallTimes& wall);

  /// Whether a frame could not be written; the next call throws the reason.
  [[nodiscard]] bool has_failed() const { return writing_.has_failed(); }

  /// Processor time that writing beside the computation has taken so far, s.
  [[nodiscard]] double writing_s() { return writing_.processor_s(); }

  [[nodiscard]] const std::vector<Observation>& rows() const { return rows_; }

 private:
  void append_series(const Observation& row);
  void append_lineage(const Division& division);
  void save_frame(const State& state);
  void write(const FrameRecord& frame);

  std::filesystem::path directory_;
  const Scenario& scenario_;
  const Model& model_;
  const Observer& observer_;
  FrameTaker frame_taker_;
  RowFile series_;
  std::optional<RowFile> lineage_;
  std::vector<Observation> rows_;
  double last_frame_s_ = 0;

  // Of `write`, while frames are being written.
  RowFile midline_;
  std::optional<RowFile> cells_;
  std::vector<std::pair<double, std::string>> frames_;  // time, file
  ReportFrames report_;
  Background writing_;  // the last member: it ends before what it writes with
};

}  // namespace plica
