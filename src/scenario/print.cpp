#include "scenario/print.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <ranges>

#include "scenario/schema.hpp"

namespace plica {

std::string in_toml(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (code < 0x20 || code == 0x7f) {
      quoted += fmt::format("\\u{:04X}", code);
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

namespace {

using plica::in_toml;  // of a text, among the others
std::string in_toml(int value) { return fmt::format("{}", value); }
std::string in_toml(double value) { return fmt::format("{}", value); }  // the shortest that reads back exactly
std::string in_toml(bool value) { return value ? "true" : "false"; }

template <std::ranges::range Items>
std::string in_toml(const Items& items) {
  std::vector<std::string> texts;
  texts.reserve(std::ranges::size(items));
  for (const auto& item : items) texts.push_back(in_toml(item));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// The value of a row as TOML; nothing where it has none.
std::string value_text(const Row& row, Scenario& scenario, const std::string& name) {
  const auto text = [&]<class Field>(const Field& field) -> std::string {
    if constexpr (std::is_same_v<Field, std::monostate>) {
      return "";
    } else if constexpr (requires { field->has_value(); }) {
      const std::string none(row.allowed.word_for_none);
      return *field ? in_toml(**field) : none.empty() ? "" : in_toml(none);
    } else if constexpr (requires { field->empty(); }) {  // a text or a list
      return field->empty() ? "" : in_toml(*field);
    } else {
      return in_toml(*field);
    }
  };
  return std::visit(text, row.field(scenario, name));
}

std::string table_text(const TableInfo& info, const std::string& name, Scenario& scenario) {
  std::string text;
  if (!info.path.empty()) text = fmt::format("\n[{}{}{}]\n", info.stem(), name.empty() ? "" : ".", name);
  for (const Row* row : rows_of(info.path)) {
    // A stand-in says the same in another unit; only the two tolerances have a field each.
    const bool repeats = !row->options.instead_of.empty() && row->options.scale != 1;
    if (repeats || !row->used_by(scenario.embryo.shape)) continue;
    const std::string value = value_text(*row, scenario, name);
    if (!value.empty()) text += fmt::format("{} = {}\n", row->key, value);
  }
  return text;
}

std::string default_text(const Row& row) {
  if (row.options.required) return "required";
  Scenario defaults;
  const std::string value = value_text(row, defaults, "NAME");
  if (value.empty()) return "none";
  if (!row.options.instead_of.empty()) return fmt::format("see `{}`", row.options.instead_of);
  return fmt::format("`{}`", value);
}

/// A vertical bar would end the column.
std::string in_column(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string allowed_text(const Row& row) {
  std::string text = row.allowed.text();
  if (!row.options.shapes.empty()) {
    text += fmt::format("{}with shape {}", text.empty() ? "" : "; ", fmt::join(row.options.shapes, ", "));
  }
  if (!row.options.instead_of.empty()) {
    text += fmt::format("{}not with `{}`", text.empty() ? "" : "; ", row.options.instead_of);
  }
  return text.empty() ? "any" : in_column(text);
}

}  // namespace

std::string float_in_toml(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;  // n: of inf and nan
}

std::string resolved_toml(const Scenario& scenario) {
  Scenario copy = scenario;  // the table hands out pointers to fields that may be written
  std::string text = fmt::format("# {}, every default filled in.\n", scenario.name);
  for (const TableInfo& info : schema_tables()) {
    const std::vector<std::string> names = info.named() ? info.names(scenario) : std::vector<std::string>{""};
    for (const std::string& name : names) text += table_text(info, name, copy);
  }
  return text;
}

std::string reference_markdown() {
  std::string text =
      "# Scenario reference\n\n"
      "Every key of a scenario, generated from the table in `src/scenario/schema.cpp`. A scenario is a TOML file; a "
      "key\n"
      "that is not given has its default, and one that is not known is an error.\n";
  for (const TableInfo& info : schema_tables()) {
    const std::string name = info.named() ? fmt::format("{}.NAME", info.stem()) : std::string(info.path);
    text += info.path.empty() ? "\n## Top level\n\n" : fmt::format("\n## `[{}]`\n\n", name);
    text += fmt::format("{}\n\n| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n", info.meaning);
    for (const Row* row : rows_of(info.path)) {
      text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row->key, row->type(), default_text(*row),
                          allowed_text(*row), row->meaning);
    }
  }
  return text + fmt::format("\n`[expect]` knows: `{}`.\n", fmt::join(expectation_names(), "`, `"));
}

}  // namespace plica
