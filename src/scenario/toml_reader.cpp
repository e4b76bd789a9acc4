#include "scenario/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "scenario/print.hpp"
#include "scenario/suggest.hpp"

namespace plica {
namespace {

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
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

std::string trimmed(const std::string& text) {
  constexpr const char* blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
}

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

toml::table parse_toml(const std::string& file, const std::string& text) {
  if (const int line = line_of_too_deep_key(text); line > 0)
    throw ScenarioError({{file, line, "", "a key has too many parts", "use at most four parts"}});
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw ScenarioError({syntax_diagnostic(file, text, error)});
  }
}

std::string value_in_toml(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return float_in_toml(number->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* truth = node.as_boolean()) return truth->get() ? "true" : "false";
  if (const auto* text = node.as_string()) return in_toml(text->get());
  std::vector<std::string> parts;
  if (const auto* array = node.as_array()) {
    for (const toml::node& part : *array) parts.push_back(value_in_toml(part));
    return fmt::format("[{}]", fmt::join(parts, ", "));
  }
  if (const auto* table = node.as_table()) {
    for (const auto& [key, part] : *table)
      parts.push_back(fmt::format("{} = {}", in_toml(std::string(key.str())), value_in_toml(part)));
    return fmt::format("{{{}}}", fmt::join(parts, ", "));
  }
  return "";  // dates, which scenarios do not use
}

std::string word_in_toml(const std::string& text) {
  try {
    if (toml::parse("v = " + text).size() == 1) return text;
  } catch (const toml::parse_error&) {
  }
  return in_toml(text);
}

std::vector<std::pair<std::string, const toml::node*>> in_order(const toml::table& table) {
  std::vector<std::pair<std::string, const toml::node*>> rows;
  for (const auto& [key, node] : table) rows.emplace_back(key.str(), &node);
  std::ranges::stable_sort(rows, {}, [](const auto& row) {
    const auto& begin = row.second->source().begin;
    return std::pair(begin.line, begin.column);
  });
  return rows;
}

void TomlReader::refuse_unknown(const toml::table& table, const std::string& before,
                                const std::vector<std::string>& known,
                                const std::function<std::string(std::string_view)>& remedy_of) {
  for (const auto& [key, node] : table)
    if (std::ranges::count(known, key.str()) == 0)
      report_at(static_cast<int>(key.source().begin.line), before + std::string(key.str()),
                node.is_table() ? "unknown table" : "unknown key", remedy_of(key.str()));
}

void TomlReader::refuse_unknown(const toml::table& table, const std::string& before,
                                const std::vector<std::string>& known) {
  refuse_unknown(table, before, known, [&](std::string_view key) { return did_you_mean(key, known); });
}

const toml::table* TomlReader::table(const toml::table& parent, const char* key, const std::string& before) {
  const toml::node* node = parent.get(key);
  if (node == nullptr) return nullptr;
  if (!node->is_table()) report(*node, before + key, "is not a table", fmt::format("write [{}{}]", before, key));
  return node->as_table();
}

std::optional<int> TomlReader::count(const toml::table& table, const char* key, const std::string& before) {
  const auto number = get<std::int64_t>(table, key, before, "a whole number");
  if (number && *number >= 1 && *number <= 10'000'000) return static_cast<int>(*number);
  if (number)
    report(*table.get(key), before + key, fmt::format("{} is out of range", *number),
           fmt::format("set {} to a whole number from 1 to 10 000 000", key));
  return {};
}

void TomlReader::report_unknown_word(const toml::node& node, std::string key, const std::string& word,
                                     const std::vector<std::string>& known) {
  report(node, std::move(key), fmt::format("\"{}\" is unknown", word), did_you_mean(word, known));
}

std::optional<ScenarioSource> TomlReader::scenario(const toml::table& table, const char* key,
                                                   const std::string& before) {
  const auto name = get<std::string>(table, key, before, "a text");
  if (!name) return {};
  try {
    const std::filesystem::path folder = std::filesystem::path(file_).parent_path();
    std::error_code unknown;
    const bool is_file = std::filesystem::is_regular_file(folder / *name, unknown);
    return find_scenario(is_file ? (folder / *name).string() : *name, folder);
  } catch (const std::runtime_error& error) {
    report(*table.get(key), before + key, error.what(),
           fmt::format("set {} to a built-in name or a path relative to this file", key));
    return {};
  }
}

void TomlReader::read_overrides(const toml::table& table, std::vector<std::string>& overrides, std::vector<int>& lines,
                                const std::string& before) {
  for (const auto& [key, node] : table) {
    const std::string path = before + std::string(key.str());
    if (node.is_table() && !node.as_table()->is_inline()) {
      read_overrides(*node.as_table(), overrides, lines, path + ".");
    } else {
      overrides.push_back(path + "=" + value_in_toml(node));
      lines.push_back(static_cast<int>(key.source().begin.line));
    }
  }
}

}  // namespace plica
