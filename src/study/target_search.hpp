// Search for a point where several numbers meet their targets; each evaluation costs a run.
//
// One number and one coordinate: a bracketing search (TOMS 748: cubic and quadratic interpolation that never leaves the
// bracket). Otherwise COBYLA (Powell 1994) on the misses as equations: it fits each miss by a linear function on n + 1
// points and steps to the smallest largest miss within a shrinking radius. With several keys and targets it acts as
// Newton's method without derivatives and within bounds. Rejected: BOBYQA on the sum of
// squares of the misses, which must learn the curvature of that sum first, and Nelder-Mead: both need three to four
// times as many runs (docs/how-to/calibrate.md).
#pragma once

#include <functional>
#include <vector>

namespace plica {

/// Result of one evaluation.
struct Look {
  std::vector<double> misses;  // targets, in units of their tolerances: met from -1 to 1; empty: no value
  bool over = false;           // end the search: targets met, or limit reached
};

/// Evaluate a point: coordinates in [0, 1]; keys.
using LookAt = std::function<Look(const std::vector<double>&)>;

/// Evaluate points until `look` reports `over` or no nearby point is better (steps below 1e-4). Starts at `start`; with
/// a single target at the bounds. A point without a value counts as worse than all others.
void search_targets(const std::vector<double>& start, std::size_t targets, const LookAt& look);

/// Largest absolute miss; infinite without a value.
double worst_miss(const std::vector<double>& misses);

}  // namespace plica
