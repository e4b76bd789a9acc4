#include "scenario/schema.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "measure/measure_set.hpp"

namespace plica {

bool Allowed::contains(double value) const {
  return (low_included ? value >= low : value > low) && (high_included ? value <= high : value < high);
}

const KeyRow* row_of_key(std::string_view dotted) {
  // Returns a key without its first part.
  const auto behind = [](std::string_view key) {
    const std::size_t dot = key.find('.');
    return dot == std::string_view::npos ? std::string_view() : key.substr(dot + 1);
  };
  for (const ScenarioTable& table : scenario_tables()) {
    std::string_view key = dotted;
    if (!table.path.empty() && !key.starts_with(std::string(table.stem()) + '.')) continue;
    if (!table.path.empty()) key = behind(key);
    if (table.named()) key = behind(key);
    for (const KeyRow& row : table.rows)
      if (key == row.key) return &row;
  }
  return nullptr;
}

std::string Allowed::text() const {
  if (!words.empty()) return fmt::format("{}", fmt::join(words, " | "));
  const double infinity = std::numeric_limits<double>::infinity();
  std::string range;
  if (low == high) {
    range = fmt::format("{}", low);
  } else if (low > -infinity && high < infinity && low_included && high_included) {
    range = fmt::format("{} to {}", low, high);
  } else {
    if (low > -infinity) range = fmt::format("{} {}", low_included ? ">=" : ">", low);
    if (high < infinity)
      range += fmt::format("{}{} {}", range.empty() ? "" : " and ", high_included ? "<=" : "<", high);
  }
  return word_for_none.empty() ? range : fmt::format("{} or \"{}\"", range, word_for_none);
}

std::string KeyRow::type() const {
  Scenario scratch;
  const Slot slot = field(scratch, "name");
  const bool has_words = !allowed.words.empty();
  if (std::holds_alternative<int*>(slot) || std::holds_alternative<std::optional<int>*>(slot)) return "integer";
  if (std::holds_alternative<double*>(slot) || std::holds_alternative<std::optional<double>*>(slot)) return "number";
  if (std::holds_alternative<bool*>(slot) || std::holds_alternative<std::optional<bool>*>(slot)) return "true or false";
  if (std::holds_alternative<std::optional<Range>*>(slot)) return "[low, high]";
  if (std::holds_alternative<std::array<int, 3>*>(slot)) return "3 integers";
  if (std::holds_alternative<std::vector<int>*>(slot)) return "list of integers";
  if (std::holds_alternative<std::vector<double>*>(slot)) return "list of numbers";
  if (std::holds_alternative<std::vector<std::string>*>(slot)) return has_words ? "list of words" : "list of texts";
  if (std::holds_alternative<std::map<std::string, double>*>(slot)) return "table of numbers";
  return has_words ? "word" : "text";
}

std::string KeyRow::expected() const {
  const std::string type = this->type();
  const std::string range = allowed.text();
  if (type == "word") return "one of: " + range;
  if (type == "list of words") return "a list of: " + range;
  if (type == "text" && key.ends_with("region")) return "\"all\", or to the name of another region";
  const bool plain = type == "text" || type == "true or false" || type == "[low, high]" || type == "3 integers";
  std::string noun = type == "text" ? "a text" : plain ? type : (type == "integer" ? "an " : "a ") + type;
  if (range.empty()) return noun;
  return noun + (range.front() == '>' || range.front() == '<' ? " " : ", ") + range;
}

std::string KeyRow::remedy() const { return fmt::format("set {} to {}", key.substr(key.rfind('.') + 1), expected()); }

bool KeyRow::used_by(std::string_view shape) const {
  return options.shapes.empty() || std::ranges::find(options.shapes, shape) != options.shapes.end();
}

std::span<const InnerTables> inner_tables() {
  static const std::vector<InnerTables> tables = {
      {"Activity time course",
       {"program", "stiffness_program"},
       "Piecewise linear activity, constant before the first and after the last time. Without it, activity is 1. It "
       "scales the tension of `[contraction.NAME]`, the active tension (`program`) and stiffness (`stiffness_program`) "
       "of `[cortex.NAME]`, the pressure of `[pressure.NAME]`, and the stiffness of `[foundation.NAME]` and "
       "`[matrix.NAME]`."},
      {"Trigger and follow",
       {"trigger", "follow"},
       "Cell-autonomous activity, by shape or `[signal.NAME]`. `trigger` starts both time courses of a cell at a "
       "threshold; before, tension is 0 and stiffness that of time 0. `follow` multiplies the active tension by a "
       "linear function of it; by a signal, also `[contraction.NAME]`, `[pressure.NAME]`, `[growth.NAME]` and the "
       "stiffness of `[foundation.NAME]` and `[matrix.NAME]`. Shape is measured at the start of each step, relative to "
       "the reference state; `apical_stretch` is the largest stretch of the apical surface."},
      {"Profile",
       {"profile"},
       "Spatial profile: amplitude factor per cell, by distance d from the centre of the region, from `middle` at the "
       "centre to `edge` far away. Keys ending in `_deg` require axis `angle`."},
      {"Variation", {"variation"}, "Random amplitude factor per cell: log-normal with mean 1."},
      {"Delay and pulse",
       {"delay", "pulse"},
       "Activation wave, behind which cells start their time course, and pulsatile activity with the factor 1 + "
       "`amplitude` sin(2π(t/period + phase))."},
  };
  return tables;
}

std::span<const KeyRow> rows_of(std::string_view table) {
  for (const ScenarioTable& one : scenario_tables())
    if (one.path == table) return one.rows;
  return {};
}

std::span<const std::string_view> expectation_names() {
  // Output variables, and other machine-independent numbers of summary.json.
  static const std::vector<std::string_view> names = [] {
    std::vector<std::string_view> all;
    for (const Column& column : columns())
      if (column.in_summary != InSummary::nothing) all.push_back(column.name);
    all.insert(all.end(), {"equilibrium_time_s", "time_s", "cells", "nodes"});
    return all;
  }();
  return names;
}

void reset_to_default(const KeyRow& row, Scenario& scenario, const std::string& name) {
  Scenario defaults;
  const Slot from = row.field(defaults, name);
  const Slot to = row.field(scenario, name);
  std::visit(
      [&](auto target) {
        if constexpr (!std::is_same_v<decltype(target), std::monostate>) *target = *std::get<decltype(target)>(from);
      },
      to);
}

}  // namespace plica
