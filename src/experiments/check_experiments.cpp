#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/errors.hpp"
#include "experiments/experiments.hpp"
#include "scenario/schema.hpp"
#include "study/design.hpp"
#include "study/quiet_run.hpp"

namespace plica {
namespace {

// Line of a draw in its file.
int line_of(std::size_t draw) { return static_cast<int>(draw) + 2; }

// Check the draws by themselves: unknown keys and invalid values.
void check_draws(const Experiments& experiments, std::vector<Diagnostic>& diagnostics) {
  const StudyDesign& draws = experiments.draws;
  for (std::size_t k = 0; k < draws.keys.size(); ++k) {
    const std::string& key = draws.keys[k];
    const bool is_known = row_of_key(key) != nullptr;
    for (std::size_t d = 0; d < (is_known ? draws.runs.size() : 1); ++d)
      for (const Diagnostic& problem : problems_of_override(key + "=" + draws.runs[d].values[k]))
        diagnostics.push_back({experiments.draws_file, is_known ? line_of(d) : 1,
                               fmt::format("column {} ({})", k + 1, key), problem.problem, problem.remedy});
  }
}

ScenarioError in_experiments(const ScenarioError& error, const Experiments& experiments, const Experiment& experiment,
                             std::size_t draw) {
  const ScenarioError in_study = plica::in_study(error, experiment.study);
  std::vector<Diagnostic> diagnostics = in_study.diagnostics();
  for (Diagnostic& one : diagnostics) {
    if (one.file != experiments.file && one.file != "--set") continue;
    const bool is_of_draw = one.key.starts_with("vary.");
    const std::string key = one.key.substr(is_of_draw ? std::string("vary.").size() : 0);
    if (is_of_draw)
      one = {experiments.draws_file, line_of(draw), key, one.problem, one.remedy};
    else
      one.file = experiments.file, one.key = fmt::format("experiment.{}.{}", experiment.name, key);
  }
  return ScenarioError(std::move(diagnostics));
}

// Names of the numbers that a run of an experiment has; empty if its scenario is invalid.
struct KnownNames {
  std::vector<std::string> summary, series;
};

void check_quantities(const Experiments& experiments, const std::vector<KnownNames>& known,
                      std::vector<Diagnostic>& diagnostics) {
  const auto check = [&](std::size_t e, const Outcome& outcome, const Formula& formula, std::size_t which) {
    using enum Formula::Source;
    for (const auto& [name, source] : formula.uses()) {
      std::vector<std::string> names = source == summary ? known[which].summary : known[which].series;
      if (source == either) names.insert(names.end(), known[which].summary.begin(), known[which].summary.end());
      if (names.empty() || std::ranges::count(names, name) > 0) continue;
      diagnostics.push_back(
          {experiments.file, outcome.line,
           fmt::format("experiment.{}.outcome.{}.quantity", experiments.experiments[e].name, outcome.name),
           fmt::format("\"{}\" is not a {}{}", name,
                       source == summary ? "number of summary.json" : "column of series.csv",
                       which == e ? "" : " of " + experiments.experiments[which].name),
           result_remedy(name, names)});
      return false;
    }
    return true;
  };
  for (std::size_t e = 0; e < experiments.experiments.size(); ++e)
    for (const Outcome& outcome : experiments.experiments[e].outcomes) {
      if (check(e, outcome, outcome.formula, e) && outcome.comparing != Comparing::nothing)
        check(e, outcome, outcome.other_formula, outcome.compared_with);
    }
}

}  // namespace

std::vector<std::string> Experiments::overrides(std::size_t experiment, std::size_t draw) const {
  std::vector<std::string> all;
  if (experiments[experiment].drawn)
    for (std::size_t k = 0; k < draws.keys.size(); ++k) all.push_back(draws.keys[k] + "=" + draws.runs[draw].values[k]);
  const std::vector<std::string>& set = experiments[experiment].study.overrides;
  all.insert(all.end(), set.begin(), set.end());
  return all;
}

bool Experiments::use_series() const {
  return std::ranges::any_of(experiments, [](const Experiment& experiment) {
    return std::ranges::any_of(experiment.outcomes, [](const Outcome& outcome) {
      return outcome.formula.uses_series() || outcome.other_formula.uses_series();
    });
  });
}

Scenario Experiments::scenario(std::size_t experiment, std::size_t draw) const {
  try {
    return load_scenario(experiments[experiment].study.scenario, overrides(experiment, draw));
  } catch (const ScenarioError& error) {
    throw in_experiments(error, *this, experiments[experiment], draw);
  }
}

void check_experiments(const Experiments& experiments) {
  std::vector<Diagnostic> diagnostics;
  check_draws(experiments, diagnostics);
  if (!diagnostics.empty()) throw ScenarioError(std::move(diagnostics));

  // Report each problem once, whatever the number of draws and experiments that have it.
  std::set<std::string> reported;
  const auto tell = [&](const ScenarioError& error) {
    for (const Diagnostic& one : error.diagnostics())
      if (reported.insert(one.text()).second) diagnostics.push_back(one);
  };
  std::vector<KnownNames> known(experiments.experiments.size());
  for (std::size_t e = 0; e < experiments.experiments.size(); ++e) try {
      for (std::size_t d = 0; d < experiments.experiments[e].draws; ++d) {
        const Scenario scenario = experiments.scenario(e, d);
        if (d > 0) continue;
        const RunSummary rest = run_at_rest(scenario);
        known[e] = {result_names(rest.summary), rest.series_columns};
      }
    } catch (const ScenarioError& error) {
      tell(error);
    }
  check_quantities(experiments, known, diagnostics);
  if (!diagnostics.empty()) throw ScenarioError(std::move(diagnostics));
}

}  // namespace plica
