#include "experiments/outcomes.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "core/files.hpp"
#include "show/report.hpp"
#include "study/csv_fields.hpp"

namespace plica {
namespace {

std::string rounded(std::optional<double> value) { return value ? fmt::format("{:.10g}", *value + 0.0) : ""; }

// Range over all draws, if there are several with a number.
std::string range_text(const ExperimentResults& results, std::size_t e, const Outcome& outcome) {
  std::vector<double> all;
  for (std::size_t d = 0; d < results.draws(e); ++d)
    if (const auto value = results.outcome(e, outcome, d).judged) all.push_back(*value);
  if (all.size() < 2) return "";
  const auto [low, high] = std::ranges::minmax(all);
  return fmt::format("{:.4g} to {:.4g}", low + 0.0, high + 0.0);
}

std::string chance_text(const Tally& tally) {
  const Interval known = probability_of_hit(tally.hits, tally.draws);
  return tally.draws == 0 ? "" : fmt::format("{:.0f} to {:.0f} %", 100 * known.low, 100 * known.high);
}

std::vector<std::string> row_of(const ExperimentResults& results, std::size_t e, const Outcome& outcome) {
  const Tally tally = results.tally(e, outcome);
  return {results.experiments().experiments[e].name,
          outcome.name,
          outcome.question,
          outcome.observed,
          outcome.source,
          criterion_text(outcome, results.experiments()),
          rounded(results.outcome(e, outcome, 0).judged),
          range_text(results, e, outcome),
          fmt::format("{}", tally.hits),
          fmt::format("{}", tally.draws),
          chance_text(tally),
          fmt::format("{}", tally.not_solved),
          word_of(outcome.role),
          outcome.prediction ? word_of(*outcome.prediction) : "",
          results.verdict(e, outcome),
          outcome.because};
}

}  // namespace

std::string criterion_text(const Outcome& outcome, const Experiments& experiments) {
  const auto bound = [](double value) { return fmt::format("{:g}", value); };
  std::string text = outcome.quantity;
  if (outcome.comparing != Comparing::nothing)
    text += fmt::format(" {} {} of {}", outcome.comparing == Comparing::ratio ? "divided by" : "minus",
                        outcome.other_quantity.empty() ? "that" : outcome.other_quantity,
                        experiments.experiments[outcome.compared_with].name);
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

OutcomesTable outcomes_table(const ExperimentResults& results) {
  OutcomesTable table{{"experiment", "outcome", "question", "observed", "source", "criterion", "number", "all_draws",
                       "hits", "draws", "probability_of_hit", "not_solved", "role", "prediction", "verdict", "because"},
                      {},
                      {}};
  const auto& experiments = results.experiments().experiments;
  std::vector<std::pair<std::size_t, const Outcome*>> all;
  for (std::size_t e = 0; e < experiments.size(); ++e)
    for (const Outcome& outcome : experiments[e].outcomes)
      if (results.draws(e) > 0) all.emplace_back(e, &outcome);
  if (!results.experiments().are_of_claims)
    std::ranges::stable_sort(all, {}, [](const auto& one) { return one.second->role; });
  for (const auto& [e, outcome] : all) {
    table.rows.push_back(row_of(results, e, *outcome));
    if (const std::string verdict = results.verdict(e, *outcome); !verdict.empty()) ++table.verdicts[verdict];
  }
  return table;
}

std::string OutcomesTable::csv() const {
  std::string text = fmt::format("{}\n", fmt::join(columns, ","));
  for (const auto& row : rows) {
    std::vector<std::string> fields;
    for (const std::string& field : row) fields.push_back(csv_field(field));
    text += fmt::format("{}\n", fmt::join(fields, ","));
  }
  return text;
}

std::string OutcomesTable::for_terminal() const {
  std::string text;
  for (const auto& row : rows) {
    const auto field = [&](const char* name) { return row[std::ranges::find(columns, name) - columns.begin()]; };
    const std::string number = field("number"), name = field("experiment") + ", " + field("outcome");
    const std::string shown = number.empty() ? "none" : fmt::format("{:.4g}", std::stod(number));
    text += fmt::format("{:<18}  {:<34}  {:>10}  {}\n", field("verdict"), name, shown, field("criterion"));
  }
  return text;
}

void write_outcomes(const ExperimentResults& results, const OutcomesTable& table) {
  write_file(results.directory() / "outcomes.csv", table.csv());
  if (!can_report()) return;
  const auto& experiments = results.experiments().experiments;
  std::vector<std::filesystem::path> folders;
  nlohmann::ordered_json outcomes = {{"title", results.experiments().title},
                                     {"of_claims", results.experiments().are_of_claims},
                                     {"runs", nlohmann::ordered_json::array()},
                                     {"columns", table.columns},
                                     {"rows", table.rows}};
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    if (results.draws(e) == 0 || results.of(e, 0).numbers.summary.is_null()) continue;
    folders.push_back(results.folder(e, 0));
    outcomes["runs"].push_back(experiments[e].name);
  }
  write_file(results.directory() / "report.html", report_page_of(folders, outcomes));
}

}  // namespace plica
