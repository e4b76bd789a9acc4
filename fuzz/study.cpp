#include <string>

#include "core/errors.hpp"
#include "experiments/experiments.hpp"
#include "study/csv_fields.hpp"
#include "study/design.hpp"
#include "targets.hpp"

namespace plica {
namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

// A valid list of points is written as it was read, except for quotes.
void check_points(const std::string& text) try {
  const StudyDesign design = points_of_csv(text);
  const std::string written = points_csv(design);
  require(points_csv(points_of_csv(written)) == written);
} catch (const FileError&) {
}

void check_messages(const ScenarioError& error) {
  require(!error.diagnostics().empty());
  for (const Diagnostic& diagnostic : error.diagnostics())
    require(!diagnostic.problem.empty() && diagnostic.text().find('\n') == std::string::npos);
}

// Valid experiments have outcomes, each with a question, a quantity and a comparison.
void check_as_experiments(const std::string& text) try {
  const Experiments all = parse_experiments("fuzzed", "/nowhere/fuzzed.toml", text);
  require(!all.experiments.empty());
  for (const Experiment& experiment : all.experiments) {
    require(!experiment.outcomes.empty() && experiment.draws >= 1);
    for (const Outcome& outcome : experiment.outcomes)
      require(!outcome.question.empty() && !outcome.quantity.empty() &&
              outcome.compared_with < all.experiments.size());
  }
} catch (const ScenarioError& error) {
  check_messages(error);
}

}  // namespace

bool fuzz_study(std::string_view bytes) try {
  const std::string text(bytes);
  check_points(text);
  check_as_experiments(text);
  const StudyInput study = parse_study("fuzzed", "/nowhere/fuzzed.toml", text);
  require(!study.keys.empty() || study.kind == DesignKind::file);
  // Small designs that need no scenario.
  if (study.replicates > 1 || study.points > 1000 || study.keys.size() > 4) return true;
  if (study.kind != DesignKind::sobol && study.kind != DesignKind::latin_hypercube) return true;
  const StudyDesign design = design_of(study);
  require(design.runs.size() == static_cast<std::size_t>(study.points));
  for (const StudyPoint& run : design.runs) require(run.values.size() == study.keys.size());
  return true;
} catch (const ScenarioError& error) {
  check_messages(error);
  return false;
}

}  // namespace plica
