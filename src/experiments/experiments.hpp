// Experiments on a scenario, and what is expected of them before they are run: a file, read and checked.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "study/design.hpp"
#include "study/study_input.hpp"

namespace plica {

/// What an outcome was to the model when the experiment was written down.
enum class Role {
  predicted,  // nothing was known of it, or used
  selected,   // one model was chosen before another by it
  seen,       // known before, and not used
  fitted      // parameters were chosen by it
};
const char* word_of(Role role);

/// What a measured number says about what was observed; of one run, or of many.
enum class Judgement {
  hit,
  miss,
  undecided,
  not_solved,  // of one run: it has no result
};
const char* word_of(Judgement judgement);

/// The number that is asked for: a run's own, or compared with the same number of another experiment, draw by draw.
enum class Comparing { nothing, ratio, difference };

/// A measured number of an experiment, and which values agree with what was observed.
struct Outcome {
  std::string name;
  std::string question, observed, source, because;  // those of the experiment where it has no question of its own
  Role role = Role::predicted;
  std::optional<Judgement> prediction;  // what was expected of it
  std::string quantity;                 // a number of summary.json
  Comparing comparing = Comparing::nothing;
  std::size_t other = 0;  // the experiment that it is compared with
  // A hit within; infinite where there is no bound, and from inf to -inf where no number is a hit.
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  double margin = 0;         // undecided so far outside
  bool hit_if_none = false;  // a number that does not exist, as the time of what never happens, is a hit, else a miss
  [[nodiscard]] bool has_band() const { return low <= high; }
  int line = 0;  // of the file
};

/// A scenario with some keys changed, run once with each draw; or once as it is.
struct Experiment {
  std::string name;
  StudyInput study;       // scenario, and what `set` changes
  std::size_t draws = 0;  // the first so many
  bool drawn = true;      // false: no draw sets anything
  bool slow = false;
  std::vector<Outcome> outcomes;
};

struct Experiments {
  std::string name, file, text;  // of the file; `name` is that of the page
  std::string title;
  std::string draws_file;  // empty: one draw, which sets nothing
  StudyDesign draws;
  std::vector<Experiment> experiments;

  /// What a run says otherwise than its experiment's scenario, as of --set: its draw, then what the experiment changes.
  [[nodiscard]] std::vector<std::string> overrides(std::size_t experiment, std::size_t draw) const;
  /// ScenarioError, in the lines of the files that it comes from.
  [[nodiscard]] Scenario scenario(std::size_t experiment, std::size_t draw) const;
};

/// Reads a file of experiments, or built-in ones by their name (living). Throws FileError, UsageError where there are
/// none of that name, or ScenarioError with all that is wrong in the file.
Experiments read_experiments(const std::string& name_or_file);
/// The same of a text; `file` is what messages call it, and where paths start.
Experiments parse_experiments(const std::string& name, const std::string& file, const std::string& text);

/// Looks at every scenario with every draw, builds each experiment's tissue once, and looks for the numbers that are to
/// be measured. ScenarioError with all that is wrong.
void check_experiments(const Experiments& experiments);

}  // namespace plica
