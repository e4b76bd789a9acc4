// Simulated experiments with predictions made before they run, or that test claims: input file, parsed and checked, and
// judgement of numbers.
#pragma once

#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "experiments/formula.hpp"
#include "study/design.hpp"
#include "study/study_input.hpp"

namespace plica {

/// Role of an observation in building the model.
enum class Role {
  predicted,  // held-out test: not used to build or fit the model
  selected,   // used for model selection
  seen,       // known beforehand, not used
  fitted      // parameters were fitted to it
};
const char* word_of(Role role);

/// Agreement of a measured number with the observation, for one run or many.
enum class Judgement {
  hit,
  miss,
  undecided,
  not_solved,  // one run without a result
};
const char* word_of(Judgement judgement);

/// Number to judge: of the run itself, or relative to another experiment with the same draw.
enum class Comparing { nothing, ratio, difference };

/// Outcome measure of an experiment with the range of values that agree with the observation.
struct Outcome {
  std::string name;
  std::string question, observed, source, because;  // those of the experiment unless it has its own question
  Role role = Role::predicted;
  std::optional<Judgement> prediction;   // predicted judgement
  std::string quantity, other_quantity;  // as in the file; the second empty if the same
  Formula formula, other_formula;        // here, and in the experiment it is compared with
  Comparing comparing = Comparing::nothing;
  std::size_t compared_with = 0;  // index of the experiment it is compared with
  // Range of hits; infinite if unbounded, and from inf to -inf if no number is a hit.
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double margin = 0;         // width of the undecided range outside
  bool hit_if_none = false;  // a missing number (time of an event that never happens) is a hit; else a miss
  [[nodiscard]] bool has_band() const { return low <= high; }
  int line = 0;  // in the file
};

/// Number to judge, from the run's own value and that of the other experiment; empty if a value is missing or a ratio
/// has denominator 0.
std::optional<double> compared(const Outcome& outcome, std::optional<double> value,
                               std::optional<double> compared_value);

/// Judge one run: hit from `low` to `high`, undecided up to `margin` outside, else miss. A missing value is a
/// miss, or a hit with `hit_if_none`; a missing compared value is undecided.
Judgement judge(const Outcome& outcome, std::optional<double> value, std::optional<double> compared_value = {});

struct Interval {
  double low = 0, high = 1;
};

/// Credible interval (90 %) of the probability of a hit after `hits` of `draws` with a uniform prior: central interval
/// of Beta(1 + hits, 1 + draws - hits).
Interval probability_of_hit(std::size_t hits, std::size_t draws);

/// Counts of an outcome over its draws.
struct Tally {
  std::size_t draws = 0, hits = 0, misses = 0, not_solved = 0;

  /// Hit if 80 % of the draws hit, miss if 80 % miss, else undecided (also without draws).
  [[nodiscard]] Judgement verdict() const;
};
Tally tally_of(std::span<const Judgement> draws);

/// Verdict of a claim: reproduced if it is a hit in every reading of an open text (draw); under this reading if in the
/// first but not in all, or fitted; else not reproduced.
enum class ClaimVerdict { reproduced, under_this_reading, not_reproduced, not_solved };
const char* word_of(ClaimVerdict verdict);
ClaimVerdict verdict_of_claim(std::optional<Judgement> first, bool in_every_reading, Role role);

/// Experiment: scenario with some keys changed, run once per draw, or once as it is.
struct Experiment {
  std::string name;
  StudyInput study;       // scenario and overrides of `set`
  std::size_t draws = 0;  // number of draws used, from the first
  bool drawn = true;      // false: draws are not applied
  bool slow = false;
  std::vector<Outcome> outcomes;
};

struct Experiments {
  std::string name, file, text;  // of the file; `name` is also that of the page
  std::string title;
  bool are_of_claims = false;  // verdicts are those of claims: reproduced, under this reading, not reproduced
  std::string draws_file;      // empty: one draw without values
  StudyDesign draws;
  std::vector<Experiment> experiments;

  /// Overrides of a run in the form of --set: values of the draw, then those of the experiment.
  [[nodiscard]] std::vector<std::string> overrides(std::size_t experiment, std::size_t draw) const;
  /// Whether an outcome needs the series of a run.
  [[nodiscard]] bool use_series() const;
  /// Load the scenario of a run. Throws ScenarioError, located in the source files.
  [[nodiscard]] Scenario scenario(std::size_t experiment, std::size_t draw) const;
};

/// Read a file of experiments, or built-in ones by name (paper, living). Throws FileError, UsageError for an unknown
/// name, or ScenarioError with all problems of the file.
Experiments read_experiments(const std::string& name_or_file);
/// Parse the text of experiments. `file`: name in messages and base of relative paths.
Experiments parse_experiments(const std::string& name, const std::string& file, const std::string& text);

/// Check every scenario with every draw, build the tissue of each experiment once, and check that its outcome measures
/// exist. Throws ScenarioError with all problems.
void check_experiments(const Experiments& experiments);

}  // namespace plica
