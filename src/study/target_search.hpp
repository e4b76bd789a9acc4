// Finds where several numbers meet their targets, when each look at them costs a whole run.
//
// One number and one coordinate: a bracketing search (TOMS 748: cubic and quadratic interpolation that never leaves the
// bracket). Otherwise COBYLA (Powell 1994) on the misses as equations: it fits each miss by a linear function on n + 1
// places and steps to where the largest of them is least, within a radius that shrinks. So with several keys and
// targets it does what Newton's method does, without derivatives and within bounds. Rejected: BOBYQA on the sum of
// squares of the misses, which must learn the curvature of that sum first, and Nelder-Mead: both need three to four
// times as many runs (docs/how-to/calibrate.md).
#pragma once

#include <functional>
#include <vector>

namespace plica {

/// What a look at a place gave.
struct Look {
  std::vector<double> misses;  // a target each, in units of its tolerance: met at -1 to 1; empty: there is no value
  bool over = false;           // the search is to end: targets met, or enough of it
};

/// Looks at a place: a coordinate from 0 to 1 for each key.
using LookAt = std::function<Look(const std::vector<double>&)>;

/// Looks at places until `look` says that it is over, or until no place nearby is better (steps below 1e-4). Starts at
/// `start`; a single miss at the ends. Where `look` has no value, the place counts as worse than all others.
void search_targets(const std::vector<double>& start, std::size_t targets, const LookAt& look);

/// The largest miss without its sign; infinite where there is no value.
double worst_miss(const std::vector<double>& misses);

}  // namespace plica
