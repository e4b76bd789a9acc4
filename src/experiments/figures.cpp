#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/page.hpp"
#include "record/results.hpp"
#include "show/chart.hpp"

namespace plica {
namespace {

constexpr double min_per_s = 1.0 / 60;

// Experiment shown beside another in its figure.
std::optional<std::size_t> shown_beside(const Experiments& experiments, std::size_t e) {
  for (const Outcome& outcome : experiments.experiments[e].outcomes)
    if (outcome.comparing != Comparing::nothing) return outcome.other;
  return e > 0 ? std::optional<std::size_t>(0) : std::nullopt;
}

// Column over time: all draws of an experiment as one curve with gaps between them.
Curve all_draws(const ExperimentResults& results, std::size_t e, const std::string& column) {
  Curve curve{results.experiments().experiments[e].name, {}, {}};
  for (std::size_t d = 0; d < results.draws(e); ++d) {
    if (!results.of(e, d).has_ended() || results.of(e, d).summary.is_null()) continue;
    const Series series = read_series(results.folder(e, d) / "series.csv");
    if (!series.column(column)) continue;
    const Curve one = column_of(series, "", column, min_per_s);
    curve.x.insert(curve.x.end(), one.x.begin(), one.x.end());
    curve.y.insert(curve.y.end(), one.y.begin(), one.y.end());
    curve.x.push_back(std::numeric_limits<double>::quiet_NaN());
    curve.y.push_back(std::numeric_limits<double>::quiet_NaN());
  }
  return curve;
}

}  // namespace

Figure outcome_figure(const ExperimentResults& results, std::size_t experiment, const Outcome& outcome) {
  const std::string& name = results.experiments().experiments[experiment].name;
  Plot plot{fmt::format("{}: {}", name, outcome.name),
            {"draw", false, 0.5, static_cast<double>(results.draws(experiment)) + 0.5, true},
            {outcome.comparing == Comparing::nothing
                 ? outcome.quantity
                 : fmt::format("{}, {} {}", outcome.quantity, outcome.comparing == Comparing::ratio ? "over" : "minus",
                               results.experiments().experiments[outcome.other].name)},
            {},
            {},
            {}};
  if (outcome.has_band()) plot.horizontal.push_back({"hit", outcome.low, outcome.high});
  for (const Judgement judgement : {Judgement::hit, Judgement::miss, Judgement::undecided}) {
    Curve curve{word_of(judgement), {}, {}, true, false};
    for (std::size_t d = 0; d < results.draws(experiment); ++d) {
      const DrawOutcome result = results.outcome(experiment, outcome, d);
      if (result.judgement != judgement || !result.number) continue;
      curve.x.push_back(static_cast<double>(d) + 1);
      curve.y.push_back(*result.number);
    }
    plot.curves.push_back(std::move(curve));
  }
  return chart(
      fmt::format("{}-{}", name, outcome.name), plot,
      fmt::format("**{}** of {} by draw (dots); shaded: range that counts as a hit. Draws without a value are omitted.",
                  outcome.name, name));
}

std::optional<Figure> course_figure(const ExperimentResults& results, std::size_t experiment) {
  const Experiment& own = results.experiments().experiments[experiment];
  std::vector<std::string> columns = {"furrow_depth_um"};
  for (const Outcome& outcome : own.outcomes) columns.push_back(outcome.quantity);
  for (const std::string& column : columns) {
    const Curve curve = all_draws(results, experiment, column);
    if (curve.x.empty() || std::ranges::all_of(curve.x, [](double x) { return std::isnan(x); })) continue;
    Plot plot{fmt::format("{} over time", column), {"time, min"}, {column}, {}, {}, {}};
    if (const auto beside = shown_beside(results.experiments(), experiment))
      if (Curve other = all_draws(results, *beside, column); !other.x.empty()) plot.curves.push_back(std::move(other));
    plot.curves.push_back(curve);
    return chart(own.name + "-course", plot,
                 plot.curves.size() > 1
                     ? fmt::format("`{}` over time, all draws, compared with {}.", column, plot.curves.front().name)
                     : fmt::format("`{}` over time, all draws.", column));
  }
  return {};
}

}  // namespace plica
