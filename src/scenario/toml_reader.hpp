// What readers of TOML files that are no scenarios have in common (studies, experiments): values of their types, and
// all that is wrong, with its line, its key and what would be right.
#pragma once

#include <toml++/toml.h>

#include <cmath>
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

/// The table that a text holds. ScenarioError where it is no TOML, or its keys are nested without end.
toml::table parse_toml(const std::string& file, const std::string& text);

/// A value in TOML, on one line.
std::string value_in_toml(const toml::node& node);

/// The keys of a table in the order of the file.
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

  /// `before`: what messages call the table, with a point.
  void refuse_unknown(const toml::table& table, const std::string& before, const std::vector<std::string>& known,
                      const std::function<std::string(std::string_view)>& remedy_of);
  void refuse_unknown(const toml::table& table, const std::string& before, const std::vector<std::string>& known);

  /// A table within another; nothing where it is not there.
  const toml::table* table(const toml::table& parent, const char* key, const std::string& before = "");

  /// `what` it is to be: "a text". Numbers are finite.
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
    report(*node, before + key, "is not " + std::string(what), "give " + std::string(what));
    return {};
  }

  /// A whole number from 1 on.
  std::optional<int> count(const toml::table& table, const char* key, const std::string& before);

  /// One of some words, given as pairs of word and value; nothing where the key is not there, or is none of them.
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

  /// A scenario that is built in, or a file beside this one.
  std::optional<ScenarioSource> scenario(const toml::table& table, const char* key, const std::string& before = "");

  /// A table of a scenario's keys, nested or dotted, as of --set, and the lines that they stand in.
  void read_overrides(const toml::table& table, std::vector<std::string>& overrides, std::vector<int>& lines,
                      const std::string& before = "");

  std::vector<Diagnostic> diagnostics_;

 private:
  void report_unknown_word(const toml::node& node, std::string key, const std::string& word,
                           const std::vector<std::string>& known);

  std::string file_;
};

}  // namespace plica
