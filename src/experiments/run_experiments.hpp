// The runs of experiments, each with its draw, and what they came to. A directory has
//
//   experiments.toml      the file, as given         runs/NAME/draw-1/   all that `plica run` leaves
//   experiments.csv       a row an outcome and draw   runs/NAME/draw-2/   scenario.toml, series.csv, summary.json
//   NAME.md, .html        the page, with figures/     unfinished/         runs that take long, from half minute to half
//                                                                         minute
//
// A run that has ended has a summary.json, and is not made again: whatever is interrupted or killed, the same command
// goes on. Runs are the same to the bit whoever makes them.
#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "experiments/experiments.hpp"
#include "experiments/judgement.hpp"

namespace plica {

/// How a run ended.
struct DrawResult {
  nlohmann::ordered_json summary;  // null where it has none
  std::string status = "not_run";  // that of its summary; refused: no valid scenario; crashed: its process ended twice
  std::string reason;              // of what is refused, failed or crashed

  [[nodiscard]] bool has_ended() const { return status != "not_run"; }
  /// Whether its numbers are those of its scenario: not where the numerics gave up on the way.
  [[nodiscard]] bool is_solved() const { return status == "equilibrium" || status == "end_time"; }
};

/// What an outcome came to with one draw.
struct DrawOutcome {
  std::optional<double> own, other, number;  // the quantity; of the experiment that it is compared with; what is judged
  std::optional<Judgement> judgement;        // none: has not run
};

/// The runs of experiments in a directory.
class ExperimentResults {
 public:
  /// `quick`: the first draw only, without slow experiments. Reads what has ended. FileError where that is damaged,
  /// UsageError where a run is of another scenario than it would be now.
  ExperimentResults(const Experiments& experiments, std::filesystem::path directory, bool quick);

  [[nodiscard]] const Experiments& experiments() const { return experiments_; }
  [[nodiscard]] const std::filesystem::path& directory() const { return directory_; }
  [[nodiscard]] bool quick() const { return quick_; }
  /// How many draws of an experiment are planned; none of one that is left out.
  [[nodiscard]] std::size_t draws(std::size_t experiment) const { return results_[experiment].size(); }
  [[nodiscard]] std::filesystem::path folder(std::size_t experiment, std::size_t draw) const;
  [[nodiscard]] const DrawResult& of(std::size_t experiment, std::size_t draw) const {
    return results_[experiment][draw];
  }

  struct Run {
    std::size_t experiment, draw;
  };
  /// All that have not ended: of every experiment the first draw, then of each the second, and so on.
  [[nodiscard]] std::vector<Run> open_runs() const;
  [[nodiscard]] std::size_t runs() const;
  [[nodiscard]] std::size_t ended() const { return runs() - open_runs().size(); }
  /// Runs that have ended without a result: which, and why.
  [[nodiscard]] std::vector<std::string> not_solved() const;

  /// Makes a run on one thread, into its folder. Nothing is returned when it was stopped; else the reason why it left
  /// nothing, or an empty text.
  [[nodiscard]] std::optional<std::string> make(const Run& run, const std::function<bool()>& stop) const;
  /// Reads what a run has left; with a reason, why it has left nothing.
  void take(const Run& run, const std::string& status = "", const std::string& reason = "");

  [[nodiscard]] DrawOutcome outcome(std::size_t experiment, const Outcome& outcome, std::size_t draw) const;
  /// Of all draws that have ended.
  [[nodiscard]] Tally tally(std::size_t experiment, const Outcome& outcome) const;

  /// A row an outcome and draw; nothing in it depends on the machine or its clock.
  [[nodiscard]] std::string csv() const;

 private:
  const Experiments& experiments_;
  std::filesystem::path directory_;
  bool quick_;
  std::vector<std::vector<DrawResult>> results_;  // by experiment and draw
};

struct ExperimentHooks {
  std::function<void()> on_run = {};          // after each run that has ended
  std::function<bool()> stop_requested = {};  // asked often; once true, what runs is given up
};

/// Makes a directory ready: begun anew with `overwrite`, and gone on with where it holds experiments. UsageError where
/// it holds anything else.
void begin_experiments(const std::filesystem::path& directory, const Experiments& experiments, bool overwrite);

/// Makes the runs that have not ended, `jobs` at a time, and writes experiments.csv, also when it is stopped.
void run_experiments(ExperimentResults& results, int jobs, const ExperimentHooks& hooks);

}  // namespace plica
