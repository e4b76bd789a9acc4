// Text of scenarios and of other TOML files (studies, experiments): limits before it is parsed, syntax errors, and the
// base of the others' readers, with typed values and errors with line, key and remedy.
#pragma once

#include <toml++/toml.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/errors.hpp"
#include "scenario/load.hpp"

namespace plica {

/// Returns a text without blanks at its ends.
std::string trimmed(const std::string& text);

/// Converts a parse error of `text` (named `file` in messages) to a message: a key set twice, text without quotes, or
/// the library's own description.
Diagnostic syntax_diagnostic(const std::string& file, const std::string& text, const toml::parse_error& error);

inline constexpr std::uintmax_t largest_scenario_bytes = std::uintmax_t{4} << 20;

/// Largest number of scenarios in a chain of bases.
inline constexpr std::size_t most_bases = 16;

/// Largest number of parts of a dotted key; scenario keys have at most four.
inline constexpr int most_key_parts = 16;

/// Returns the line of a key with more than `most_key_parts` parts, or 0. The TOML library recurses once per part and
/// would overflow the stack; it rejects deeply nested values itself.
int line_of_too_deep_key(std::string_view text);

/// Parses a text. Throws ScenarioError for invalid TOML or too deeply nested keys.
toml::table parse_toml(const std::string& file, const std::string& text);

/// Writes a value in TOML, on one line.
std::string value_in_toml(const toml::node& node);

/// Returns a value in TOML as it is, and a bare word as a text in TOML.
std::string word_in_toml(const std::string& text);

/// Returns the keys of a table in file order.
std::vector<std::pair<std::string, const toml::node*>> in_order(const toml::table& table);

class TomlReader {
 protected:
  explicit TomlReader(std::string file) : file_(std::move(file)) {}

  void report_at(int line, std::string key, std::string problem, std::string remedy) {
    diagnostics_.push_back({file_, line, std::move(key), std::move(problem), std::move(remedy)});
  }
  void report(const toml::node& node, std::string key, std::string problem, std::string remedy) {
    report_at(static_cast<int>(node.source().begin.line), std::move(key), std::move(problem), std::move(remedy));
  }
  void throw_what_is_wrong() {
    if (!diagnostics_.empty()) throw ScenarioError(std::move(diagnostics_));
  }

  /// Reports keys that are not in `known`. `before`: name of the table in messages, with a trailing dot.
  void refuse_unknown(const toml::table& table, const std::string& before, const std::vector<std::string>& known,
                      const std::function<std::string(std::string_view)>& remedy_of);
  void refuse_unknown(const toml::table& table, const std::string& before, const std::vector<std::string>& known);

  /// Returns an inner table, or null if absent.
  const toml::table* table(const toml::table& parent, const char* key, const std::string& before = "");

  /// Reads a value; reports a wrong type. `what`: the expected type in messages ("a text"). Numbers must be finite.
  template <class Value>
  std::optional<Value> get(const toml::table& table, const char* key, const std::string& before, const char* what) {
    const toml::node* node = table.get(key);
    if (node == nullptr) return {};
    if constexpr (std::is_same_v<Value, double>) {
      const std::optional<double> number = node->is_number() ? node->value<double>() : std::nullopt;
      if (number && std::isfinite(*number)) return number;
    } else if (std::optional<Value> value = node->value_exact<Value>()) {
      return value;
    }
    report(*node, before + key, "is not " + std::string(what), "set " + std::string(key) + " to " + std::string(what));
    return {};
  }

  /// Reads a whole number from 1 to 10 000 000.
  std::optional<int> count(const toml::table& table, const char* key, const std::string& before);

  /// Reads one of the words in `choices`, pairs of word and value; nothing if absent or unknown.
  template <class Choices>
  auto word(const toml::table& table, const char* key, const std::string& before, const Choices& choices)
      -> std::optional<std::remove_cvref_t<decltype(choices[0].second)>> {
    const auto text = get<std::string>(table, key, before, "a text");
    if (!text) return {};
    std::vector<std::string> known;
    for (const auto& [name, value] : choices) {
      if (name == *text) return value;
      known.emplace_back(name);
    }
    report_unknown_word(*table.get(key), before + key, *text, known);
    return {};
  }

  /// Finds a scenario: a file relative to this one, or a built-in.
  std::optional<ScenarioSource> scenario(const toml::table& table, const char* key, const std::string& before = "");

  /// Reads a table of scenario keys, nested or dotted, as overrides in the form of --set, and their lines.
  void read_overrides(const toml::table& table, std::vector<std::string>& overrides, std::vector<int>& lines,
                      const std::string& before = "");

  std::vector<Diagnostic> diagnostics_;

 private:
  void report_unknown_word(const toml::node& node, std::string key, const std::string& word,
                           const std::vector<std::string>& known);

  std::string file_;
};

}  // namespace plica
