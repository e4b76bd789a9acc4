// Comparison of simulated times.
#pragma once

#include <algorithm>

namespace plica {

/// Times closer than this are one instant, s: no step leads from one to the other. Cells move within seconds and
/// minutes; rounding errors are far smaller.
inline constexpr double instant_s = 1e-6;

/// Whether `point_s` is before `time_s` or the same instant.
inline bool has_come(double point_s, double time_s) { return point_s <= time_s + std::max(instant_s, 1e-12 * time_s); }

inline bool is_same_instant(double point_s, double time_s) {
  return has_come(point_s, time_s) && has_come(time_s, point_s);
}

}  // namespace plica
