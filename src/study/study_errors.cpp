#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "scenario/print.hpp"
#include "scenario/schema.hpp"
#include "scenario/suggest.hpp"
#include "study/design.hpp"

namespace plica {
namespace {

struct GivenKey {
  std::string table, key;  // "vary" or "set"
  int line = 0;
};

std::vector<GivenKey> given_keys(const StudyInput& study) {
  std::vector<GivenKey> keys;
  for (const StudyKey& key : study.keys) keys.push_back({"vary", key.key, key.line});
  for (std::size_t i = 0; i < study.overrides.size(); ++i)
    keys.push_back({"set", study.overrides[i].substr(0, study.overrides[i].find('=')), study.override_lines[i]});
  return keys;
}

// Table of the scenario that contains a key: "cortex.apical" or "solver".
std::string table_of(const std::string& key) {
  const KeyRow* row = row_of_key(key);
  const std::size_t first = key.find('.');
  const bool is_named = row == nullptr || row->table.ends_with(".*");
  return key.substr(0, is_named && first != std::string::npos ? key.find('.', first + 1) : first);
}

// Key of the study that causes an error: the same key, or the most similar one of the same table.
const GivenKey* source_of(const Diagnostic& diagnostic, const std::vector<GivenKey>& given) {
  const auto likeness = [&](const GivenKey& one) {
    return std::ranges::mismatch(one.key, diagnostic.key).in1 - one.key.begin();
  };
  const GivenKey* best = nullptr;
  for (const GivenKey& one : given) {
    if (one.key == diagnostic.key) return &one;
    const bool is_near = table_of(one.key) == table_of(diagnostic.key) || one.key.starts_with(diagnostic.key + ".");
    if (is_near && (best == nullptr || likeness(one) > likeness(*best))) best = &one;
  }
  return best;
}

// Scenario without the study; empty if it is invalid by itself.
std::optional<Scenario> scenario_alone(const StudyInput& study) {
  try {
    return load_scenario(study.scenario);
  } catch (const ScenarioError&) {
    return {};
  }
}

// Name the existing tables in an error about a table that only the study mentions, probably by mistake.
void tell_of_new_table(Diagnostic& diagnostic, const std::string& key, const Scenario& scenario) {
  const std::string table = table_of(key);
  for (const ScenarioTable& info : scenario_tables()) {
    if (!info.named() || !table.starts_with(std::string(info.stem()) + '.')) continue;
    const std::string name = table.substr(info.stem().size() + 1);
    const std::vector<std::string> names = info.names(scenario);
    if (std::ranges::count(names, name) > 0) return;
    diagnostic.problem = fmt::format("the scenario has no {}", table);
    diagnostic.remedy = did_you_mean(name, names);
  }
}

Diagnostic in_study(Diagnostic diagnostic, const StudyInput& study, const std::vector<GivenKey>& given,
                    const std::optional<Scenario>& alone) {
  const bool is_own = diagnostic.file == "--set";
  if (!is_own && (diagnostic.file == study.file || !alone)) return diagnostic;
  const GivenKey* source = source_of(diagnostic, given);
  if (source == nullptr) return diagnostic;
  const std::string problem = diagnostic.problem;
  if (!is_own) {
    const std::string place =
        diagnostic.line > 0 ? fmt::format("{}:{}", diagnostic.file, diagnostic.line) : diagnostic.file;
    diagnostic.problem =
        fmt::format("conflicts with {} of the scenario ({}), which {}", diagnostic.key, place, problem);
  } else if (alone && problem == "is missing") {
    tell_of_new_table(diagnostic, source->key, *alone);
  }
  const bool is_told = diagnostic.problem != problem || source->key.starts_with(diagnostic.key);
  if (!is_told) diagnostic.problem = fmt::format("then {} {}", diagnostic.key, problem);
  if (diagnostic.problem.ends_with("is not an integer"))
    diagnostic.remedy = "give integers: values, or low and high with step = 1";
  return {study.file, source->line, source->table + "." + source->key, diagnostic.problem, diagnostic.remedy};
}

}  // namespace

ScenarioError in_study(const ScenarioError& error, const StudyInput& study) {
  const std::vector<GivenKey> given = given_keys(study);
  const std::optional<Scenario> alone = scenario_alone(study);
  std::vector<Diagnostic> diagnostics;
  std::set<std::string> reported;
  for (const Diagnostic& diagnostic : error.diagnostics()) {
    const Diagnostic mapped = in_study(diagnostic, study, given, alone);
    if (reported.insert(mapped.text()).second) diagnostics.push_back(mapped);
  }
  return ScenarioError(std::move(diagnostics));
}

void require_values_of_keys(const StudyInput& study, const StudyDesign& design) {
  std::vector<Diagnostic> diagnostics;
  std::set<std::pair<std::size_t, std::string>> tried;
  const auto try_value = [&](std::size_t k, const std::string& value, const std::string& file, int line) {
    if (!tried.insert({k, value}).second) return;
    for (Diagnostic problem : problems_of_override(design.keys[k] + "=" + value)) {
      if (!file.empty()) problem = {file, line, problem.key, problem.problem, problem.remedy};
      diagnostics.push_back(std::move(problem));
    }
  };
  for (std::size_t k = 0; k < study.keys.size(); ++k)
    for (const double bound : {study.keys[k].low, study.keys[k].high})
      if (study.keys[k].values.empty() && std::isfinite(bound) && !study.keys[k].is_whole)
        try_value(k, float_in_toml(bound), "", 0);
  const bool is_of_file = study.kind == DesignKind::file;
  for (const StudyPoint& run : design.runs)
    for (std::size_t k = 0; k < design.keys.size(); ++k)
      try_value(k, run.values[k], is_of_file ? study.points_file : "", run.point + 1);
  if (!diagnostics.empty()) throw in_study(ScenarioError(std::move(diagnostics)), study);
}

void require_usable_values(const StudyInput& study, const StudyDesign& design) {
  using Value = std::pair<std::size_t, std::string>;  // of a key
  std::set<Value> usable;
  std::map<Value, std::vector<Diagnostic>> problems;
  const auto each_listed = [&](const StudyPoint& run, const auto& take) {
    for (std::size_t k = 0; k < study.keys.size(); ++k)
      if (!study.keys[k].values.empty()) take(Value(k, run.values[k]));
  };
  for (const StudyPoint& run : design.runs) {
    bool is_new = false;
    each_listed(run, [&](const Value& value) { is_new = is_new || !usable.contains(value); });
    if (!is_new) continue;
    try {
      (void)load_scenario(study.scenario, overrides_of(study, design, run));
      each_listed(run, [&](const Value& value) { usable.insert(value); });
    } catch (const ScenarioError& error) {
      each_listed(run, [&](const Value& value) {
        for (const Diagnostic& problem : error.diagnostics())
          if (problem.key == study.keys[value.first].key && problems[value].empty()) problems[value].push_back(problem);
      });
    }
  }
  std::vector<Diagnostic> diagnostics;
  for (const auto& [value, found] : problems)
    if (!usable.contains(value)) diagnostics.insert(diagnostics.end(), found.begin(), found.end());
  if (!diagnostics.empty()) throw in_study(ScenarioError(std::move(diagnostics)), study);
}

}  // namespace plica
