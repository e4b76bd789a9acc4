// Parsing of text: numbers, and byte-order marks, with which editors and spreadsheets begin Unicode text.
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

/// Return UTF-8 text without its mark, if it has one.
inline std::string_view without_byte_order_mark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

/// Whether text begins with the mark of UTF-16, which no reader understands.
inline bool is_utf16(std::string_view text) { return text.starts_with("\xff\xfe") || text.starts_with("\xfe\xff"); }

}  // namespace plica
