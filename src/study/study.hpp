// A study that is ready to run: what its file says, its points, and what one of its runs comes to.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.hpp"
#include "study/design.hpp"
#include "study/study_input.hpp"

namespace plica {

/// What a run came to: a row of runs.csv.
struct RunRow {
  std::string status;  // that of summary.json; refused: no valid scenario; crashed: its process ended
  std::vector<std::optional<double>> measures;
  int steps = 0;
  double wall_s = 0;
  std::string reason;  // of what is refused, failed or crashed
};

class Study {
 public:
  /// Makes the design, and one run at rest to see what there is to measure. ScenarioError, in the lines of the study's
  /// file, when no point is a valid scenario or a key or measure is not known.
  explicit Study(StudyInput input);
  /// One that has been looked at before.
  Study(StudyInput input, StudyDesign design, std::vector<std::string> measures);

  [[nodiscard]] const StudyInput& input() const { return input_; }
  [[nodiscard]] const StudyDesign& design() const { return design_; }
  [[nodiscard]] std::size_t runs() const { return design_.runs.size(); }
  [[nodiscard]] const std::vector<std::string>& measures() const { return measures_; }

  /// What is allowed, and may not be meant.
  [[nodiscard]] std::vector<Diagnostic> notes() const;

  /// ScenarioError where its values do not make a scenario.
  [[nodiscard]] Scenario scenario_of(std::size_t run) const;
  /// Names its files.
  [[nodiscard]] std::string name_of(std::size_t run) const;

  /// Runs it on one thread; nothing when `stop` became true on the way, or another process is at it. What the study
  /// keeps of each run is written into `directory`/points; what takes longer than half a minute goes on where it was
  /// broken off. FileError when that cannot be written.
  [[nodiscard]] std::optional<RunRow> run(std::size_t run, const std::filesystem::path& directory,
                                          const std::function<bool()>& stop = {}) const;

  /// point, the keys, replicate, status, the measures, steps, wall_s, reason.
  [[nodiscard]] std::string header() const;
  /// Of a run that has not ended.
  [[nodiscard]] RunRow not_run() const { return {"not_run", decltype(RunRow::measures)(measures_.size()), 0, 0, ""}; }
  [[nodiscard]] std::string line_of(std::size_t run, const RunRow& row) const;

 private:
  void check();
  StudyInput input_;
  StudyDesign design_;
  std::vector<std::string> measures_;
};

}  // namespace plica
