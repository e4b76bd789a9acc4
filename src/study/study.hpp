// Study that is ready to run: its input, its points, and the result of one run.
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

/// Result of a run: a row of runs.csv.
struct RunRow {
  std::string status;  // of summary.json; refused: invalid scenario; crashed: its process ended
  std::vector<std::optional<double>> measures;
  int steps = 0;
  double wall_s = 0;
  std::string reason;  // why it was refused, failed or crashed
};

class Study {
 public:
  /// Compute the design and measure one reference state to learn the output variables. Throws ScenarioError, located in
  /// the study's file, if no point is valid or a key or output variable is unknown.
  explicit Study(StudyInput input);
  /// Study whose design and output variables are known.
  Study(StudyInput input, StudyDesign design, std::vector<std::string> measures);

  [[nodiscard]] const StudyInput& input() const { return input_; }
  [[nodiscard]] const StudyDesign& design() const { return design_; }
  [[nodiscard]] std::size_t runs() const { return design_.runs.size(); }
  [[nodiscard]] const std::vector<std::string>& measures() const { return measures_; }

  /// Notes on input that is allowed, but possibly not intended.
  [[nodiscard]] std::vector<Diagnostic> notes() const;

  /// Scenario of a run. Throws ScenarioError for invalid values.
  [[nodiscard]] Scenario scenario_of(std::size_t run) const;
  [[nodiscard]] std::string name_of(std::size_t run) const;

  /// Make a run on one thread; empty if `stop` became true, or another process makes it. Kept files go to
  /// `directory`/points; a run longer than 30 s resumes where it was interrupted. Throws FileError.
  [[nodiscard]] std::optional<RunRow> run(std::size_t run, const std::filesystem::path& directory,
                                          const std::function<bool()>& stop = {}) const;

  /// Header of runs.csv: point, keys, replicate, status, output variables, steps, wall_s, reason.
  [[nodiscard]] std::string header() const;
  [[nodiscard]] std::string line_of(std::size_t run, const RunRow& row) const;
  /// Line of a run without a result: not_run, or crashed with a reason.
  [[nodiscard]] std::string line_without_result(std::size_t run, const std::string& crash = "") const {
    return line_of(run,
                   {crash.empty() ? "not_run" : "crashed", decltype(RunRow::measures)(measures_.size()), 0, 0, crash});
  }

 private:
  void check();
  StudyInput input_;
  StudyDesign design_;
  std::vector<std::string> measures_;
};

}  // namespace plica
