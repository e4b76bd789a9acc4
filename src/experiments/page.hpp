// Page of experiments: all outcomes in one table, then each experiment with its numbers and figures.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run_experiments.hpp"
#include "show/document.hpp"

namespace plica {

struct ExperimentsPage {
  Document document;
  std::map<Judgement, std::size_t> verdicts;  // number of outcomes by verdict
  std::vector<std::string> missing_pictures;  // name and reason
};

/// Make the page from the finished runs.
ExperimentsPage experiments_page(const ExperimentResults& results);

/// Criterion in words: "`furrow_depth_um` divided by that of reference, 0 to 0.3".
std::string criterion_text(const Outcome& outcome, const Experiments& experiments);

/// Figure of an outcome's numbers by draw with the range of hits.
Figure outcome_figure(const ExperimentResults& results, std::size_t experiment, const Outcome& outcome);

/// Figure of a time series of all draws, beside the experiment it is compared with, or the first one: furrow depth, or
/// the first outcome measure in series.csv. Empty if there is none.
std::optional<Figure> course_figure(const ExperimentResults& results, std::size_t experiment);

}  // namespace plica
