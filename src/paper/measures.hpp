// Figures of finished runs, the basis of claims, readings and error bars.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "record/results.hpp"
#include "scenario/scenario.hpp"

namespace plica {

/// Measured numbers by name, which includes the unit; missing values are absent.
using Figures = std::map<std::string, double>;

/// Add figures with `prefix` before their names.
void add_prefixed(Figures& figures, const std::string& prefix, const Figures& more);

/// Add monitors of the last and third-last contractile midline cells to the built-in second-last. `along`: number of
/// contractile cells along the midline.
void watch_ends(Scenario& scenario, int along);

/// Measure one run from its series.csv and summary.json, at equilibrium (the paper's stop) or, without it, at the end.
/// Speeds and displacements with VCE as the last, second-last or third-last cell end in _1, _2, _3; those of the
/// second-last also have no ending.
Figures figures_of_run(const std::filesystem::path& run);

/// Interval in which both displacements are in the printed ranges (both_in_range_from_s, _until_s), first time with
/// every node slower than the printed 0.2 um/s (slower_than_printed_s) and furrow depth then (depth_then_um).
/// Interpolated.
Figures printed_times(const Series& series);

/// Onset times of contractile midline cells.
struct Onsets {
  std::vector<double> ap_um;   // reference x
  std::vector<double> time_s;  // first time at a tenth of the final depth
};

/// Measure onsets. `early`: run with frequent snapshots; `late`: run to equilibrium, for the final depths. `along`:
/// number of contractile cells.
Onsets onsets(const std::filesystem::path& early, const std::filesystem::path& late, int along);

/// Figures of onsets: spread_s (last minus first), ends_s, middle_s, and rank_correlation (Spearman) of time with
/// distance from the centre: -1 if the ends are first and the centre last.
Figures figures_of_onsets(const Onsets& onsets);

}  // namespace plica
