// Fields of CSV texts, quoted where necessary (RFC 4180).
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/numbers.hpp"

namespace plica {

/// Quote a field if necessary.
inline std::string csv_field(std::string_view text) {
  if (text.find_first_of(",\"\n\r") == std::string_view::npos) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

/// Parse all rows of a text; empty lines are skipped.
inline std::vector<std::vector<std::string>> csv_fields(std::string_view text) {
  text = without_byte_order_mark(text);
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> row(1);
  bool is_quoted = false;
  const auto end_row = [&] {
    if (row.size() > 1 || !row.front().empty()) rows.push_back(std::move(row));
    row.assign(1, "");
  };
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool doubled = c == '"' && i + 1 < text.size() && text[i + 1] == '"';
    if (is_quoted && doubled)
      row.back() += text[i++];
    else if (c == '"')
      is_quoted = !is_quoted;
    else if (is_quoted)
      row.back() += c;
    else if (c == ',')
      row.emplace_back();
    else if (c == '\n')
      end_row();
    else if (c != '\r')
      row.back() += c;
  }
  end_row();
  return rows;
}

}  // namespace plica
