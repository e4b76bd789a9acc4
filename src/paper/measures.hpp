// Figures taken from finished runs: all that claims, readings and error bars are made of.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "record/results.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Measured numbers by name; what has no value is not there. Names say the unit.
using Figures = std::map<std::string, double>;

/// Every name with `prefix` before it.
void add_prefixed(Figures& figures, const std::string& prefix, const Figures& more);

/// Watches the last and the third-last contractile cell of the midline beside the built-in second-last. `along`: cells
/// that contract along the midline.
void watch_ends(Scenario& scenario, int along);

/// Of one run of an embryo, from its series.csv and summary.json. States are those at rest (the paper's stop), or at
/// the end where rest was not reached. Speeds and displacements with VCE the last, second-last, third-last cell end in
/// _1, _2, _3; those of the second-last have no ending.
Figures figures_of_run(const std::filesystem::path& run);

/// When both displacements are in the ranges that the paper prints (both_in_range_from_s, _until_s), and when every
/// node is slower than its 0.2 um/s for the first time (slower_than_printed_s) and how deep the furrow is then
/// (depth_then_um). Linear between rows.
Figures printed_times(const Series& series);

/// When each contractile midline cell sets off.
struct Onsets {
  std::vector<double> ap_um;   // x at rest
  std::vector<double> time_s;  // first time at a tenth of its final depth
};

/// `early`: a run with close frames; `late`: one that comes to rest, for the final depths. `along` cells contract.
Onsets onsets(const std::filesystem::path& early, const std::filesystem::path& late, int along);

/// spread_s: last less first; ends_s and middle_s; rank_correlation of time with the distance from the middle
/// (Spearman): -1 where the ends go first and the middle last.
Figures figures_of_onsets(const Onsets& onsets);

}  // namespace plica
