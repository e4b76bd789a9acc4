// Times on the command line.
#pragma once

#include <fmt/format.h>

#include <optional>
#include <string>

#include "core/errors.hpp"
#include "core/numbers.hpp"

namespace plica {

/// Convert "5min", "300s" or "300" to seconds; empty for "last". Throws UsageError for other text.
inline std::optional<double> seconds_in(const std::string& text) {
  if (text == "last") return {};
  const double unit_s = text.ends_with("min") ? 60 : 1;
  const std::size_t unit_letters = text.ends_with("min") ? 3 : text.ends_with('s') ? 1 : 0;
  const auto value = number_in(std::string_view(text).substr(0, text.size() - unit_letters));
  if (!value) throw UsageError(fmt::format("--time {}: not a time; give 5min, 300s, 300 (seconds) or last", text));
  return *value * unit_s;
}

}  // namespace plica
