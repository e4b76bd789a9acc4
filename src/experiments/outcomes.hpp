// Outcomes of experiments in one table, for outcomes.csv, the terminal and report.html.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "experiments/run_experiments.hpp"

namespace plica {

struct OutcomesTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;  // of experiments with a planned run; held-out tests first
  std::map<std::string, std::size_t> verdicts;

  [[nodiscard]] std::string csv() const;
  /// The columns that fit into a line: verdict, name, number and criterion.
  [[nodiscard]] std::string for_terminal() const;
};

OutcomesTable outcomes_table(const ExperimentResults& results);

/// Criterion in words: "furrow_depth_um divided by that of reference, 0 to 0.3".
std::string criterion_text(const Outcome& outcome, const Experiments& experiments);

/// Write outcomes.csv and, in builds with the viewer, report.html with the first draws of all experiments.
void write_outcomes(const ExperimentResults& results, const OutcomesTable& table);

}  // namespace plica
