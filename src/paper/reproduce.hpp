// `plica reproduce`: every experiment of the paper, and a page that holds its printed figures beside ours.
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
  int at_a_time = 2;
};

struct ReproduceOutcome {
  bool interrupted = false;
  int claims = 0, reproduced = 0, under_this_reading = 0;  // rows, and how many have the better verdicts
  std::vector<std::string> failed_runs;                    // id and message
  std::vector<std::string> missing_figures;                // name and why
};

/// Makes the runs (DIR/runs, over those that lie there) and writes DIR/reproduction.md and .html with DIR/figures.
/// `tell` hears of it when it begins and of each run that ends: how many have, of how many. FileError when DIR cannot
/// be written.
ReproduceOutcome reproduce(const ReproduceOptions& options,
                           const std::function<void(std::size_t done, std::size_t count)>& tell,
                           const std::function<bool()>& interrupted);

/// The page, from what was measured; counts its verdicts in `outcome`.
Document reproduction_document(const Results& results, const Measured& measured, const Plan& plan, bool quick,
                               ReproduceOutcome& outcome);

/// Plots and pictures of the paper's figures 4, 5 and 7 to 11, of the mechanism, the onset and the trade-off. What its
/// runs lack is left out. Names of those that could not be made, with the reason, are added to `missing`.
std::vector<Figure> reproduction_figures(const Results& results, const Measured& measured,
                                         std::vector<std::string>& missing);

}  // namespace plica
