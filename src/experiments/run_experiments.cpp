#include "experiments/run_experiments.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <new>
#include <numeric>

#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/threads.hpp"
#include "record/archive.hpp"
#include "record/csv.hpp"
#include "record/results.hpp"
#include "record/run_directory.hpp"
#include "scenario/print.hpp"
#include "show/recorded_run.hpp"
#include "show/report.hpp"
#include "study/csv_fields.hpp"
#include "study/quiet_run.hpp"

namespace plica {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

std::string draw_name(std::size_t draw) { return fmt::format("draw-{}", draw + 1); }

// Refuse existing runs of another scenario.
void require_same_scenario(const fs::path& folder, const Scenario& scenario) {
  if (!is_there(folder / "scenario.toml")) return;
  const auto differences = scenario_differences(read_file(folder / "scenario.toml"), resolved_toml(scenario));
  if (differences.empty()) return;
  throw UsageError(fmt::format(
      "{}: was run with another scenario: {}; revert the change, remove {} to rerun it, or give another --out",
      folder.string(), differences.front().text(), folder.parent_path().string()));
}

// Write the files of a run other than the first draw.
void write_short(const fs::path& folder, const Scenario& scenario, const RunSummary& run) {
  make_directory(folder);
  std::string series = fmt::format("{}\n", fmt::join(run.series_columns, ","));
  for (const Observation& row : run.rows) series += series_row(row, run.columns) + '\n';
  write_file(folder / "scenario.toml", resolved_toml(scenario));
  write_file(folder / "series.csv", series);
  write_file(folder / "summary.json", run.summary.dump(2, ' ', false, Json::error_handler_t::replace) + '\n');
}

// Runs of the first draw are recorded in full; others keep only numbers.
bool is_recorded(std::size_t draw) { return draw == 0 && can_archive(); }

std::string number(std::optional<double> value) { return value ? fmt::format("{}", *value) : ""; }

}  // namespace

ExperimentResults::ExperimentResults(const Experiments& experiments, fs::path directory, bool quick)
    : experiments_(experiments), directory_(std::move(directory)), quick_(quick) {
  for (std::size_t e = 0; e < experiments.experiments.size(); ++e) {
    const Experiment& experiment = experiments.experiments[e];
    results_.emplace_back(!quick ? experiment.draws : experiment.slow ? 0 : 1);
    for (std::size_t d = 0; d < results_[e].size(); ++d) {
      require_same_scenario(folder(e, d), experiments.scenario(e, d));
      take({e, d});
    }
  }
}

fs::path ExperimentResults::folder(std::size_t experiment, std::size_t draw) const {
  return directory_ / "runs" / experiments_.experiments[experiment].name / draw_name(draw);
}

std::size_t ExperimentResults::runs() const {
  return std::accumulate(results_.begin(), results_.end(), std::size_t{0},
                         [](std::size_t sum, const auto& draws) { return sum + draws.size(); });
}

std::vector<ExperimentResults::Run> ExperimentResults::open_runs() const {
  std::vector<Run> open;
  for (std::size_t d = 0; open.size() < runs() && d < experiments_.draws.runs.size(); ++d)
    for (std::size_t e = 0; e < results_.size(); ++e)
      if (d < draws(e) && !of(e, d).has_ended()) open.push_back({e, d});
  return open;
}

std::vector<std::string> ExperimentResults::not_solved() const {
  std::vector<std::string> texts;
  for (std::size_t e = 0; e < results_.size(); ++e)
    for (std::size_t d = 0; d < draws(e); ++d)
      if (const DrawResult& run = of(e, d); run.has_ended() && !run.is_solved())
        texts.push_back(
            fmt::format("{}, draw {}: {}: {}", experiments_.experiments[e].name, d + 1, run.status, run.reason));
  return texts;
}

std::optional<std::string> ExperimentResults::make(const Run& run, const std::function<bool()>& stop) const {
  const auto& [e, d] = run;
  try {
    const Scenario scenario = experiments_.scenario(e, d);
    if (is_recorded(d)) {
      const Json summary = run_recorded(folder(e, d), scenario, experiments_.experiments[e].study.scenario, stop);
      return summary.at("status") == "interrupted" ? std::nullopt : std::optional<std::string>("");
    }
    const std::string name = experiments_.experiments[e].name + "-" + draw_name(d);
    const RunSummary ran = quiet_run(scenario, {stop, {}, {}, directory_ / "unfinished" / name});
    if (ran.summary.at("status") == "interrupted") return std::nullopt;
    write_short(folder(e, d), scenario, ran);
    return "";
  } catch (const ScenarioError& error) {
    return error.what();
  } catch (const UsageError& error) {
    throw FileError(error.what());
  } catch (const std::bad_alloc&) {
    return "out of memory";
  }
}

void ExperimentResults::take(const Run& run, const std::string& status, const std::string& reason) {
  DrawResult& result = results_[run.experiment][run.draw];
  result = {};
  if (!status.empty()) {
    result.status = status, result.reason = reason;
    std::ranges::replace(result.reason, '\n', ' ');  // it becomes a CSV field
    return;
  }
  const fs::path made = folder(run.experiment, run.draw);
  if (is_recorded(run.draw) && !holds_ending(made, can_report())) return;  // killed while it wrote its last files
  const Json summary = read_summary(made);
  if (summary.is_null() || summary.value("status", "interrupted") == "interrupted") return;
  result.status = summary.value("status", "");
  if (const auto failure = summary.find("failure"); failure != summary.end() && failure->is_string())
    result.reason = failure->get<std::string>();
  result.numbers.summary = summary;
  if (experiments_.use_series()) result.numbers.series = read_series(made / "series.csv");
}

DrawOutcome ExperimentResults::outcome(std::size_t experiment, const Outcome& outcome, std::size_t draw) const {
  const bool is_compared = outcome.comparing != Comparing::nothing;
  DrawOutcome result;
  for (const std::size_t e : {experiment, is_compared ? outcome.compared_with : experiment}) {
    const DrawResult& run = of(e, draw);
    if (!run.has_ended()) return {};
    if (!run.is_solved()) result.judgement = Judgement::not_solved;
  }
  if (result.judgement) return result;
  result.value = outcome.formula.value(of(experiment, draw).numbers);
  if (is_compared) result.compared_value = outcome.other_formula.value(of(outcome.compared_with, draw).numbers);
  result.judged = compared(outcome, result.value, result.compared_value);
  result.judgement = judge(outcome, result.value, result.compared_value);
  return result;
}

Tally ExperimentResults::tally(std::size_t experiment, const Outcome& outcome) const {
  std::vector<Judgement> judgements;
  for (std::size_t d = 0; d < draws(experiment); ++d)
    if (const auto judgement = this->outcome(experiment, outcome, d).judgement) judgements.push_back(*judgement);
  return tally_of(judgements);
}

std::string ExperimentResults::verdict(std::size_t e, const Outcome& one) const {
  const Tally tally = this->tally(e, one);
  const Experiment& experiment = experiments_.experiments[e];
  if (tally.draws == 0) return "";
  if (!experiments_.are_of_claims) return word_of(tally.verdict());
  const std::size_t readings = experiment.drawn ? experiments_.draws.runs.size() : 1;
  return word_of(verdict_of_claim(outcome(e, one, 0).judgement, tally.hits == readings, one.role));
}

std::string ExperimentResults::csv() const {
  std::string text = "experiment,outcome,draw,status,quantity,own,other,number,judgement,reason\n";
  for (std::size_t e = 0; e < results_.size(); ++e)
    for (const Outcome& one : experiments_.experiments[e].outcomes)
      for (std::size_t d = 0; d < draws(e); ++d) {
        const DrawOutcome result = outcome(e, one, d);
        text += fmt::format("{},{},{},{},{},{},{},{},{},{}\n", experiments_.experiments[e].name, one.name, d + 1,
                            of(e, d).status, csv_field(one.quantity), number(result.value),
                            number(result.compared_value), number(result.judged),
                            result.judgement ? word_of(*result.judgement) : "", csv_field(of(e, d).reason));
      }
  return text;
}

void begin_experiments(const fs::path& directory, const Experiments& experiments, bool overwrite) {
  const bool holds_them = is_there(directory / "experiments.toml");
  if (!holds_them && holds_other_files(directory, std::array<std::string_view, 1>{"experiments.toml"}))
    throw UsageError(directory.string() + ": exists and contains no experiments; give another --out");
  std::error_code ignored;
  if (holds_them && overwrite)
    for (const char* name : {"runs", "unfinished", "experiments.csv", "outcomes.csv", "report.html"})
      fs::remove_all(directory / name, ignored);
  make_directory(directory);
  write_file(directory / "experiments.toml", experiments.text);
}

void run_experiments(ExperimentResults& results, Workers workers, const ExperimentHooks& hooks) {
  const ThreadCount one(1);
  const std::vector<ExperimentResults::Run> open = results.open_runs();
  std::vector<std::size_t> pieces(open.size());
  std::iota(pieces.begin(), pieces.end(), 0);
  // Answers of a worker: empty if stopped, "ended", or the reason of a refusal.
  constexpr const char* ended = "ended";
  const auto make = [&](std::size_t piece) -> std::string {
    const ThreadCount count(workers.threads);
    const auto reason = results.make(open[piece], worker_is_to_stop);
    return !reason ? "" : reason->empty() ? ended : *reason;
  };
  const auto take = [&](std::size_t piece, const std::string& answer, const std::string& crash) {
    if (crash.empty() && answer.empty()) return;
    if (answer == ended)
      results.take(open[piece]);
    else
      results.take(open[piece], crash.empty() ? "refused" : "crashed", crash.empty() ? answer : crash);
    if (hooks.on_run) hooks.on_run();
  };
  work_in_processes(workers.processes, pieces, make, {take, hooks.stop_requested});
  write_file(results.directory() / "experiments.csv", results.csv());
}

}  // namespace plica
