// Instants of a run's clock.
#pragma once

#include <algorithm>

namespace plica {

/// Times that are closer than this are one instant, s: no step is taken from one to the other. Cells move in seconds
/// and minutes; what rounding leaves of a second is far smaller.
inline constexpr double instant_s = 1e-6;

/// Whether a point in time has come: it is before `time_s`, or the same instant.
inline bool has_come(double point_s, double time_s) { return point_s <= time_s + std::max(instant_s, 1e-12 * time_s); }

inline bool is_same_instant(double point_s, double time_s) {
  return has_come(point_s, time_s) && has_come(time_s, point_s);
}

}  // namespace plica
