#include "scenario/nesting.hpp"

#include <algorithm>

namespace plica {
namespace {

/// Returns the end of the TOML string (any of four kinds) that starts at `begin`, or the end of the text if unclosed.
std::size_t end_of_string(std::string_view text, std::size_t begin) {
  const char quote = text[begin];
  const std::string_view three(quote == '"' ? "\"\"\"" : "'''");
  const bool is_long = text.substr(begin, 3) == three;
  for (std::size_t i = begin + (is_long ? 3 : 1); i < text.size(); ++i) {
    if (text[i] == '\\' && quote == '"') {
      ++i;
    } else if (is_long && text.substr(i, 3) == three) {
      std::size_t end = i + 3;
      for (int more = 0; more < 2 && end < text.size() && text[end] == quote; ++more)
        ++end;  // quotes inside the string
      return end;
    } else if (!is_long && (text[i] == quote || text[i] == '\n')) {
      return text[i] == quote ? i + 1 : i;
    }
  }
  return text.size();
}

}  // namespace

int line_of_too_deep_key(std::string_view text) {
  constexpr std::string_view between_keys = "=,{}[]\n";
  int line = 1, parts = 1;
  for (std::size_t i = 0; i < text.size();) {
    const char c = text[i];
    std::size_t next = i + 1;
    if (c == '"' || c == '\'') next = end_of_string(text, i);
    if (c == '#') next = std::min(text.find('\n', i), text.size());
    if (c == '.' && ++parts > most_key_parts) return line;
    if (between_keys.find(c) != std::string_view::npos) parts = 1;
    line += static_cast<int>(std::ranges::count(text.substr(i, next - i), '\n'));
    i = next;
  }
  return 0;
}

}  // namespace plica
