// What experiments came to, as a page: all outcomes in one table, then each experiment with its numbers and figures.
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
  std::map<Judgement, std::size_t> verdicts;  // how many outcomes have which
  std::vector<std::string> missing_pictures;  // name and why
};

/// Of the runs that have ended.
ExperimentsPage experiments_page(const ExperimentResults& results);

/// What is measured, and what is a hit, in words: "`furrow_depth_um` over that of reference, 0 to 0.3".
std::string criterion_text(const Outcome& outcome, const Experiments& experiments);

/// An outcome's numbers by draw beside what is a hit.
Figure outcome_figure(const ExperimentResults& results, std::size_t experiment, const Outcome& outcome);

/// A number over time, of all draws, beside those of the experiment that it is compared with, or of the first one: the
/// furrow's depth, or the first quantity of an outcome that series.csv has. Nothing where there is none.
std::optional<Figure> course_figure(const ExperimentResults& results, std::size_t experiment);

}  // namespace plica
