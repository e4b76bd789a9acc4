#include "experiments/page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "core/errors.hpp"
#include "core/version.hpp"
#include "core/words.hpp"
#include "show/chart.hpp"
#include "show/named.hpp"
#include "show/run_pictures.hpp"

namespace plica {
namespace {

constexpr std::array roles_in_order = {Role::predicted, Role::selected, Role::seen, Role::fitted};

std::string number(std::optional<double> value) { return value ? fmt::format("{:.4g}", *value + 0.0) : "none"; }

// Emphasize verdicts, and the role of held-out tests.
std::string marked(Judgement judgement) { return fmt::format("*{}*", word_of(judgement)); }
std::string marked(Role role) { return role == Role::predicted ? "**predicted**" : word_of(role); }

// Outcome with its position and results.
struct Row {
  std::size_t experiment;
  const Outcome* outcome;
  Tally tally;
};

std::vector<Row> rows_of(const ExperimentResults& results) {
  std::vector<Row> rows;
  for (std::size_t e = 0; e < results.experiments().experiments.size(); ++e)
    for (const Outcome& outcome : results.experiments().experiments[e].outcomes)
      if (results.draws(e) > 0) rows.push_back({e, &outcome, results.tally(e, outcome)});
  std::ranges::stable_sort(rows, {}, [](const Row& row) { return row.outcome->role; });
  return rows;
}

std::string share_text(const Tally& tally) {
  const Interval known = probability_of_hit(tally.hits, tally.draws);
  std::string text =
      fmt::format("{} of {} ({:.0f}–{:.0f} %)", tally.hits, tally.draws, 100 * known.low, 100 * known.high);
  if (tally.not_solved > 0) text += fmt::format("; {} not solved", tally.not_solved);
  return text;
}

// Number of the first draw, and the range over all draws if there are more.
std::string numbers_text(const ExperimentResults& results, const Row& row) {
  std::vector<double> all;
  for (std::size_t d = 0; d < results.draws(row.experiment); ++d)
    if (const auto value = results.outcome(row.experiment, *row.outcome, d).number) all.push_back(*value);
  const DrawOutcome first = results.outcome(row.experiment, *row.outcome, 0);
  const std::string text = first.judgement == Judgement::not_solved ? "not solved" : number(first.number);
  if (all.size() < 2) return text;
  const auto [low, high] = std::ranges::minmax(all);
  return fmt::format("{} ({} to {})", text, number(low), number(high));
}

void add_summary(ExperimentsPage& page, const ExperimentResults& results) {
  const std::vector<Row> rows = rows_of(results);
  Table table{{"role", "experiment", "question", "observed", "measured", "prediction", "first draw (all draws)",
               "draws that hit (90 % interval)", "verdict"},
              {}};
  for (const Row& row : rows) {
    const Outcome& outcome = *row.outcome;
    const bool has_run = row.tally.draws > 0;
    const std::string source = outcome.source.empty() ? "" : fmt::format(" ({})", outcome.source);
    table.rows.push_back({marked(outcome.role),
                          fmt::format("{}, {}", results.experiments().experiments[row.experiment].name, outcome.name),
                          outcome.question, outcome.observed + source, criterion_text(outcome, results.experiments()),
                          outcome.prediction ? word_of(*outcome.prediction) : "–",
                          has_run ? numbers_text(results, row) : "–", has_run ? share_text(row.tally) : "not run",
                          has_run ? marked(row.tally.verdict()) : "–"});
    if (has_run) ++page.verdicts[row.tally.verdict()];
  }
  std::string text;
  for (const Role role : roles_in_order) {
    std::map<Judgement, std::size_t> verdicts;
    std::size_t count = 0, expected = 0, as_expected = 0;
    for (const Row& row : rows) {
      if (row.outcome->role != role || row.tally.draws == 0) continue;
      ++count, ++verdicts[row.tally.verdict()];
      if (row.outcome->prediction) ++expected, as_expected += row.outcome->prediction == row.tally.verdict() ? 1 : 0;
    }
    if (count == 0) continue;
    text += fmt::format("Of {} {}, {} hit, {} miss and {} undecided", plural(count, "outcome"), word_of(role),
                        verdicts[Judgement::hit], verdicts[Judgement::miss], verdicts[Judgement::undecided]);
    text += expected > 0 ? fmt::format("; {} of {} as predicted. ", as_expected, expected) : ". ";
  }
  page.document.blocks.emplace_back(Heading{2, "All outcomes"});
  page.document.blocks.emplace_back(Paragraph{text.empty() ? "No run has ended." : text.substr(0, text.size() - 1)});
  page.document.blocks.emplace_back(std::move(table));
  page.document.blocks.emplace_back(Paragraph{
      "**predicted**: held-out test, not used to build or fit the model. *selected*: used for model selection. "
      "*seen*: known beforehand, not used. *fitted*: parameters were fitted to it. A draw hits if its number agrees "
      "with the observation. In brackets: 90 % credible interval of the probability that a draw hits (uniform prior). "
      "The verdict is hit if at least 80 % of the draws hit, miss if at least 80 % miss, else undecided. *not solved*: "
      "the solver failed; this does not count as a miss."});
}

std::string changes_text(const Experiment& experiment) {
  std::vector<std::string> changes;
  for (const std::string& change : experiment.study.overrides) changes.push_back("`" + change + "`");
  return changes.empty() ? "" : fmt::format(", with {}", fmt::join(changes, ", "));
}

void add_numbers(Document& page, const ExperimentResults& results, std::size_t e) {
  const Experiment& experiment = results.experiments().experiments[e];
  Table table{{"draw", "run"}, {}};
  for (const Outcome& outcome : experiment.outcomes) {
    table.header.push_back(outcome.name);
    table.header.push_back("");
  }
  for (std::size_t d = 0; d < results.draws(e); ++d) {
    const DrawResult& run = results.of(e, d);
    std::vector<std::string> row = {fmt::format("{}", d + 1),
                                    run.status + (run.reason.empty() ? "" : ": " + run.reason)};
    for (const Outcome& outcome : experiment.outcomes) {
      const DrawOutcome result = results.outcome(e, outcome, d);
      const bool has_number = result.judgement && *result.judgement != Judgement::not_solved;
      row.push_back(has_number ? number(result.number) : "–");
      row.push_back(result.judgement ? marked(*result.judgement) : "–");
    }
    table.rows.push_back(std::move(row));
  }
  page.blocks.emplace_back(std::move(table));
}

// Mid cross-section at the end of the first draw, beside that of the experiment it is compared with.
Figure section_figure(const ExperimentResults& results, std::size_t e, LazyPainter& painter) {
  (void)*painter;  // throws the reason if nothing can be drawn
  const auto& experiments = results.experiments().experiments;
  std::vector<std::size_t> shown = {e};
  for (const Outcome& outcome : experiments[e].outcomes)
    if (outcome.comparing != Comparing::nothing && shown.size() == 1) shown.insert(shown.begin(), outcome.other);
  std::optional<Picture> picture;
  for (const std::size_t which : shown) {
    PictureOptions options;
    options.views.push_back(named("--view", "cross-section", views()));
    const RunPictures run(results.folder(which, 0), options);
    Picture one = run.picture({run.times_s().back()});
    one.columns.front().heading = fmt::format("{}, {}", experiments[which].name, one.columns.front().heading);
    if (!picture) {
      picture = std::move(one);
      continue;
    }
    picture->columns.push_back(std::move(one.columns.front()));
    picture->range.high = std::max(picture->range.high, one.range.high);
  }
  return {experiments[e].name + "-section", "", "Mid cross-section at the end of the first draw. Colour: displacement.",
          "", (*painter).png(picture.value())};
}

void add_experiment(ExperimentsPage& page, const ExperimentResults& results, std::size_t e, LazyPainter& painter) {
  const Experiment& experiment = results.experiments().experiments[e];
  Document& document = page.document;
  document.blocks.emplace_back(Heading{2, experiment.name});
  document.blocks.emplace_back(
      Paragraph{fmt::format("Scenario `{}`{}.", experiment.study.scenario.name, changes_text(experiment))});
  for (const Outcome& outcome : experiment.outcomes) {
    const std::string source = outcome.source.empty() ? "" : fmt::format(" ({})", outcome.source);
    std::string text = fmt::format("**{}.** {}", outcome.name, outcome.question);
    if (!outcome.observed.empty()) text += fmt::format(" Observed: {}{}", outcome.observed, source);
    text += fmt::format(" Hit: {}.", criterion_text(outcome, results.experiments()));
    if (outcome.prediction) text += fmt::format(" Prediction: {}.", word_of(*outcome.prediction));
    if (!outcome.because.empty()) text += " Because: " + outcome.because;
    document.blocks.emplace_back(Paragraph{std::move(text)});
  }
  add_numbers(document, results, e);
  for (const Outcome& outcome : experiment.outcomes)
    if (results.draws(e) > 1) document.blocks.emplace_back(outcome_figure(results, e, outcome));
  if (auto course = course_figure(results, e)) document.blocks.emplace_back(std::move(*course));
  if (!results.of(e, 0).has_ended()) return;
  try {
    document.blocks.emplace_back(section_figure(results, e, painter));
  } catch (const FileError& error) {
    page.missing_pictures.push_back(fmt::format("{}-section: {}", experiment.name, error.what()));
  }
}

// Programs that made the runs; several if the directory was continued with another version.
std::string made_by(const ExperimentResults& results) {
  std::set<std::string> programs;
  for (std::size_t e = 0; e < results.experiments().experiments.size(); ++e)
    for (std::size_t d = 0; d < results.draws(e); ++d)
      if (const auto& summary = results.of(e, d).summary; summary.contains("provenance"))
        programs.insert(fmt::format("{} ({})", summary["provenance"].value("version", ""),
                                    summary["provenance"].value("commit", "")));
  return fmt::format("{}", fmt::join(programs, ", "));
}

}  // namespace

std::string criterion_text(const Outcome& outcome, const Experiments& experiments) {
  const auto bound = [](double value) { return fmt::format("{:g}", value); };
  std::string text = fmt::format("`{}`", outcome.quantity);
  if (outcome.comparing != Comparing::nothing)
    text += fmt::format(" {} that of {}", outcome.comparing == Comparing::ratio ? "divided by" : "minus",
                        experiments.experiments[outcome.other].name);
  if (!outcome.has_band()) return text + ": none";
  if (std::isfinite(outcome.low) && std::isfinite(outcome.high))
    text += fmt::format(", {} to {}", bound(outcome.low), bound(outcome.high));
  else if (std::isfinite(outcome.low))
    text += fmt::format(", {} or more", bound(outcome.low));
  else if (std::isfinite(outcome.high))
    text += fmt::format(", {} or less", bound(outcome.high));
  if (outcome.margin > 0) text += fmt::format(" (undecided up to {} outside)", bound(outcome.margin));
  return text + (outcome.hit_if_none ? ", or none" : "");
}

ExperimentsPage experiments_page(const ExperimentResults& results) {
  const Experiments& experiments = results.experiments();
  ExperimentsPage page{{experiments.title, {}}, {}, {}};
  const std::string by = made_by(results);
  page.document.blocks.emplace_back(Paragraph{fmt::format(
      "{}, {}, by plica {}. Runs are in `runs/`, all numbers in `experiments.csv`, plot data in `figures/`, and the "
      "experiments as given in `experiments.toml`.{}",
      plural(experiments.experiments.size(), "experiment"), plural(results.runs(), "run"), by.empty() ? version() : by,
      results.quick() ? " **Quick run: first draw only, no slow experiments.**" : "")});
  add_summary(page, results);
  LazyPainter painter;
  for (std::size_t e = 0; e < experiments.experiments.size(); ++e)
    if (results.draws(e) > 0) add_experiment(page, results, e, painter);
  for (const std::string& one : page.missing_pictures)
    page.document.blocks.emplace_back(Paragraph{"Missing: " + one + "."});
  return page;
}

}  // namespace plica
