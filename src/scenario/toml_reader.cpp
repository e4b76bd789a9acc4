#include "scenario/toml_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdint>

#include "scenario/print.hpp"
#include "scenario/suggest.hpp"
#include "scenario/syntax.hpp"

namespace plica {

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
