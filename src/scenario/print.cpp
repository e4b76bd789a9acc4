#include "scenario/print.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenario/schema.hpp"

namespace plica {
namespace {

std::string in_toml(int value) { return fmt::format("{}", value); }
std::string in_toml(double value) { return fmt::format("{}", value); }  // the shortest that reads back exactly
std::string in_toml(bool value) { return value ? "true" : "false"; }

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

template <class Items>
std::string list_in_toml(const Items& items) {
  std::vector<std::string> texts;
  texts.reserve(items.size());
  for (const auto& item : items) texts.push_back(in_toml(item));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

template <class Item, std::size_t n>
std::string in_toml(const std::array<Item, n>& items) {
  return list_in_toml(items);
}

/// The value of a row as TOML; nothing where it has none.
class ValueText {
 public:
  explicit ValueText(const Row& row) : row_(row) {}

  std::string operator()(std::monostate) const { return ""; }
  std::string operator()(const std::string* text) const { return text->empty() ? "" : in_toml(*text); }
  template <class Item>
  std::string operator()(const std::vector<Item>* items) const {
    return items->empty() ? "" : list_in_toml(*items);
  }
  template <class Value>
  std::string operator()(const std::optional<Value>* value) const {
    if (*value) return in_toml(**value);
    const std::string none(row_.allowed.word_for_none);
    return none.empty() ? "" : in_toml(none);
  }
  template <class Value>
  std::string operator()(const Value* value) const {
    return in_toml(*value);
  }

 private:
  const Row& row_;
};

std::string value_text(const Row& row, Scenario& scenario, const std::string& name) {
  return std::visit(ValueText(row), row.field(scenario, name));
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

std::string resolved_toml(const Scenario& scenario) {
  Scenario copy = scenario;  // the table hands out pointers to fields that may be written
  std::string text = fmt::format("# {}, every default filled in.\n", scenario.name);
  for (const TableInfo& info : schema_tables()) {
    if (!info.named()) text += table_text(info, "", copy);
    if (!info.named()) continue;
    for (const std::string& name : info.names(scenario)) text += table_text(info, name, copy);
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
  std::vector<std::string> names;
  for (const std::string_view name : expectation_names()) names.push_back(fmt::format("`{}`", name));
  return text + fmt::format("\n`[expect]` knows: {}.\n", fmt::join(names, ", "));
}

}  // namespace plica
