#include "scenario/syntax.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>
#include <vector>

namespace plica {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

bool is_table(const std::string& line) { return line.starts_with('['); }

// Returns the key before "=", or the table in brackets.
std::string named_in(const std::string& line) {
  if (is_table(line)) return trimmed(line.substr(0, line.find(']'))) + "]";
  return line.find('=') == std::string::npos ? "" : trimmed(line.substr(0, line.find('=')));
}

// Returns the line (from 1) before `last` that sets the same key in the same table; 0 if there is none.
int first_line_of(const std::string& name, const std::vector<std::string>& lines, int last) {
  for (int line = last - 1; line > 0; --line) {
    const std::string text = trimmed(lines[static_cast<std::size_t>(line - 1)]);
    if (named_in(text) == name) return line;
    if (is_table(text) && !is_table(name)) return 0;
  }
  return 0;
}

// Returns the word after "=" if it lacks quotes.
std::string bare_word_in(const std::string& line) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) return "";
  const std::string value = trimmed(line.substr(equals + 1, line.find('#', equals) - equals - 1));
  const auto in_word = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '.'; };
  const bool is_word = !value.empty() && std::isalpha(static_cast<unsigned char>(value.front())) != 0 &&
                       std::ranges::all_of(value, in_word);
  return is_word ? value : "";
}

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

Diagnostic syntax_diagnostic(const std::string& file, const std::string& text, const toml::parse_error& error) {
  const std::string problem(error.description());
  const int line = static_cast<int>(error.source().begin.line);
  const std::vector<std::string> lines = lines_of(text);
  if (line < 1 || static_cast<std::size_t>(line) > lines.size())
    return {file, line, "", problem, "correct the TOML syntax"};
  const std::string written = trimmed(lines[static_cast<std::size_t>(line - 1)]), name = named_in(written);
  if (problem.find("redefine") != std::string::npos && !name.empty()) {
    const int first = first_line_of(name, lines, line);
    const std::string where = first > 0 ? fmt::format(" (first in line {})", first) : "";
    return {file, line, name, "is set twice" + where, "remove one of them"};
  }
  if (const std::string word = bare_word_in(written); !word.empty())
    return {file, line, name, fmt::format("{} is not a valid value", word),
            fmt::format("put text in quotes: {} = \"{}\"", name, word)};
  return {file, line, "", problem, "correct the TOML syntax"};
}

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
