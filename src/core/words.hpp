// Numbers in words.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace plica {

inline std::string plural(std::size_t count, const char* noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

inline std::string duration(double seconds) {
  if (seconds < 100) return fmt::format("{:.1f} s", seconds);
  if (seconds < 6000) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

/// The same, rounded to what a forecast can say.
inline std::string about(double seconds) {
  if (seconds < 10) return "a few seconds";
  if (seconds < 95) return fmt::format("about {:.0f} s", 5 * std::round(seconds / 5));
  if (seconds < 5700) return fmt::format("about {:.0f} min", seconds / 60);
  return fmt::format("about {:.{}f} h", seconds / 3600, seconds < 36'000 ? 1 : 0);
}

/// Simulated time in the unit that shows it.
inline std::string moment(double time_s) {
  return time_s < 60 ? fmt::format("{:.3g} s", time_s) : fmt::format("{:.2f} min", time_s / 60);
}

}  // namespace plica
