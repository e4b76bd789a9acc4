// Parsing of numbers.
#pragma once

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace plica {

/// Parse a finite number; empty unless it is the whole text.
inline std::optional<double> number_in(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

}  // namespace plica
