// `plica reproduce`: experiments of the paper, and a page that compares printed figures with ours.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "paper/runs.hpp"
#include "show/document.hpp"

namespace plica {

struct ReproduceOptions {
  std::filesystem::path directory;
  bool quick = false;
  Workers workers = {};
};

struct ReproduceOutcome {
  bool interrupted = false;
  int claims = 0, reproduced = 0, under_this_reading = 0;  // rows, and numbers of the better verdicts
  std::vector<std::string> failed_runs;                    // id and message
  std::vector<std::string> missing_figures;                // name and reason
};

/// Make the runs (DIR/runs, replacing earlier ones) and write DIR/reproduction.md and .html with DIR/figures. `tell` is
/// called at the start and after each run, with the number of finished runs and of all. Throws FileError if DIR cannot
/// be written.
ReproduceOutcome reproduce(const ReproduceOptions& options,
                           const std::function<void(std::size_t done, std::size_t count)>& tell,
                           const std::function<bool()>& interrupted);

/// Make the page from the measurements and count its verdicts in `outcome`.
Document reproduction_document(const Results& results, const Measured& measured, const Plan& plan, bool quick,
                               ReproduceOutcome& outcome);

/// Plots and pictures of the paper's figures 4, 5 and 7 to 11, the mechanism, the onset and the trade-off, as far as
/// their runs exist. Failed ones are added to `missing` with the reason.
std::vector<Figure> reproduction_figures(const Results& results, const Measured& measured,
                                         std::vector<std::string>& missing);

}  // namespace plica
