// Runs of experiments, each with its draw, and their results. Directory:
//
//   experiments.toml   the file as given             runs/NAME/draw-1/   all files of `plica run`
//   experiments.csv    one row per outcome and draw  runs/NAME/draw-2/   scenario.toml, series.csv, summary.json
//   outcomes.csv       one row per outcome           unfinished/         state of long runs, saved every 30 s
//   report.html        outcomes and first draws
//
// A finished run has a summary.json and is not repeated: after an interruption or a kill, the same command continues.
// Results are bitwise identical, whichever process makes them.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/experiments.hpp"
#include "study/worker_pool.hpp"

namespace plica {

struct DrawResult {
  RunNumbers numbers;              // series: only if a formula uses one
  std::string status = "not_run";  // of its summary; refused: invalid scenario; crashed: its process ended twice
  std::string reason;              // why it was refused, failed or crashed

  [[nodiscard]] bool has_ended() const { return status != "not_run"; }
  /// Whether the run reached its planned end; false if the solver failed.
  [[nodiscard]] bool is_solved() const { return status == "equilibrium" || status == "end_time"; }
};

struct DrawOutcome {
  std::optional<double> value, compared_value;  // of the quantity, in this experiment and in the other
  std::optional<double> judged;                 // number that the criterion applies to
  std::optional<Judgement> judgement;           // empty: not run
};

/// Runs of experiments in a directory.
class ExperimentResults {
 public:
  /// Read the finished runs. `quick`: first draw only, without slow experiments. Throws FileError for a damaged file,
  /// UsageError if a run was made with another scenario.
  ExperimentResults(const Experiments& experiments, std::filesystem::path directory, bool quick);

  [[nodiscard]] const Experiments& experiments() const { return experiments_; }
  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  [[nodiscard]] bool quick() const { return quick_; }
  /// Number of planned draws of an experiment; 0 if it is skipped.
  [[nodiscard]] std::size_t draws(std::size_t experiment) const { return results_[experiment].size(); }
  [[nodiscard]] std::filesystem::path folder(std::size_t experiment, std::size_t draw) const;
  [[nodiscard]] const DrawResult& of(std::size_t experiment, std::size_t draw) const {
    return results_[experiment][draw];
  }

  struct Run {
    std::size_t experiment, draw;
  };
  /// Unfinished runs: the first draw of every experiment, then the second of each, and so on.
  [[nodiscard]] std::vector<Run> open_runs() const;
  [[nodiscard]] std::size_t runs() const;
  [[nodiscard]] std::size_t ended() const { return runs() - open_runs().size(); }
  /// Descriptions of the runs that ended without a result, with reasons.
  [[nodiscard]] std::vector<std::string> not_solved() const;

  /// Make a run on one thread in its folder. Returns empty if stopped, else the reason of a missing result or "".
  [[nodiscard]] std::optional<std::string> make(const Run& run, const std::function<bool()>& stop) const;
  /// Read the result of a run, or record the status and reason of a missing one.
  void take(const Run& run, const std::string& status = "", const std::string& reason = "");

  [[nodiscard]] DrawOutcome outcome(std::size_t experiment, const Outcome& outcome, std::size_t draw) const;
  /// Count the finished draws.
  [[nodiscard]] Tally tally(std::size_t experiment, const Outcome& outcome) const;
  /// Verdict in words; empty without runs.
  [[nodiscard]] std::string verdict(std::size_t experiment, const Outcome& outcome) const;

  /// Table with one row per outcome and draw; independent of the machine and its clock.
  [[nodiscard]] std::string csv() const;

 private:
  const Experiments& experiments_;
  std::filesystem::path directory_;
  bool quick_;
  std::vector<std::vector<DrawResult>> results_;  // by experiment and draw
};

struct ExperimentHooks {
  std::function<void()> on_run = {};          // after each finished run
  std::function<bool()> stop_requested = {};  // polled often; once true, runs are abandoned
};

/// Prepare a directory: emptied with `overwrite`, else continued if it contains experiments. Throws UsageError if it
/// contains other files.
void begin_experiments(const std::filesystem::path& directory, const Experiments& experiments, bool overwrite);

/// Make the unfinished runs and write experiments.csv, also when stopped.
void run_experiments(ExperimentResults& results, Workers workers, const ExperimentHooks& hooks);

}  // namespace plica
