#include "scenario/print.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <toml++/toml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <ranges>
#include <sstream>

#include "scenario/schema.hpp"

namespace plica {
namespace {

using Values = std::map<std::string, std::string>;  // by dotted key

void flatten(const toml::table& table, const std::string& path, Values& values) {
  for (const auto& [key, node] : table) {
    const std::string here = path + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      flatten(*inner, here + ".", values);
      continue;
    }
    std::ostringstream text;
    node.visit([&](const auto& value) { text << value; });
    values[here] = text.str();
  }
}

Values values_of(std::string_view text) {
  Values values;
  try {
    flatten(toml::parse(text), "", values);
  } catch (const toml::parse_error&) {
  }
  return values;
}

}  // namespace

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

using plica::in_toml;  // overload for texts
std::string in_toml(int value) { return fmt::format("{}", value); }
std::string in_toml(double value) { return fmt::format("{}", value); }  // the shortest text that reads back exactly
std::string in_toml(bool value) { return value ? "true" : "false"; }

std::string in_toml(const std::map<std::string, double>& numbers) {
  std::vector<std::string> texts;
  for (const auto& [name, number] : numbers) texts.push_back(fmt::format("{} = {}", name, number));
  return fmt::format("{{ {} }}", fmt::join(texts, ", "));
}

template <std::ranges::range Items>
std::string in_toml(const Items& items) {
  std::vector<std::string> texts;
  texts.reserve(std::ranges::size(items));
  for (const auto& item : items) texts.push_back(in_toml(item));
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

/// Returns the value of a row in TOML, or an empty text without a value.
std::string value_text(const KeyRow& row, Scenario& scenario, const std::string& name) {
  const auto text = [&]<class Field>(const Field& field) -> std::string {
    if constexpr (std::is_same_v<Field, std::monostate>) {
      return "";
    } else if constexpr (requires { field->has_value(); }) {
      const std::string none(row.allowed.word_for_none);
      return *field ? in_toml(**field) : none.empty() ? "" : in_toml(none);
    } else if constexpr (requires { field->empty(); }) {  // text or list
      return field->empty() ? "" : in_toml(*field);
    } else {
      return in_toml(*field);
    }
  };
  return std::visit(text, row.field(scenario, name));
}

std::string table_text(const ScenarioTable& info, const std::string& name, Scenario& scenario) {
  std::string text;
  if (!info.path.empty()) text = fmt::format("\n[{}{}{}]\n", info.stem(), name.empty() ? "" : ".", name);
  for (const KeyRow& row : info.rows) {
    // Alternatives in another unit fill the same field; only the two tolerances have a field each.
    const bool repeats = !row.options.instead_of.empty() && row.options.scale != 1;
    if (repeats || !row.used_by(scenario.embryo.shape)) continue;
    const std::string value = value_text(row, scenario, name);
    if (!value.empty()) text += fmt::format("{} = {}\n", row.key, value);
  }
  return text;
}

std::string default_text(const KeyRow& row) {
  if (row.options.required) return "required";
  Scenario defaults;
  const std::string value = value_text(row, defaults, "NAME");
  if (value.empty()) return "none";
  if (!row.options.instead_of.empty()) return fmt::format("see `{}`", row.options.instead_of);
  return fmt::format("`{}`", value);
}

/// Escapes vertical bars, which would end the column.
std::string in_column(const std::string& text) {
  std::string result;
  for (const char c : text) result += c == '|' ? std::string("\\|") : std::string(1, c);
  return result;
}

std::string allowed_text(const KeyRow& row) {
  std::string text = row.allowed.text();
  if (!row.options.shapes.empty())
    text += fmt::format("{}with shape {}", text.empty() ? "" : "; ", fmt::join(row.options.shapes, ", "));
  if (!row.options.instead_of.empty())
    text += fmt::format("{}not with `{}`", text.empty() ? "" : "; ", row.options.instead_of);
  return text.empty() ? "any" : in_column(text);
}

// The reference page.

std::string name_of(const ScenarioTable& info) {
  return info.named() ? fmt::format("{}.NAME", info.stem()) : std::string(info.path);
}

std::string heading_of(const ScenarioTable& info) {
  return info.path.empty() ? "Top level" : fmt::format("`[{}]`", name_of(info));
}

/// Links to a heading, by the anchor that GitHub and Sphinx derive from it.
std::string link_to(std::string_view label, std::string_view heading) {
  std::string anchor;
  for (const unsigned char c : heading) {
    if (std::isalnum(c) != 0 || c == '_' || c == '-') anchor += static_cast<char>(std::tolower(c));
    if (c == ' ') anchor += '-';
  }
  return fmt::format("[{}](#{})", label, anchor);
}

/// Returns the shared inner tables of a row, or null for a key of the table itself.
const InnerTables* inner_of(const KeyRow& row) {
  const std::size_t dot = row.key.find('.');
  if (dot == std::string_view::npos) return nullptr;
  for (const InnerTables& inner : inner_tables())
    if (std::ranges::find(inner.keys, row.key.substr(0, dot)) != inner.keys.end()) return &inner;
  return nullptr;
}

std::vector<const KeyRow*> own_rows(const ScenarioTable& info) {
  std::vector<const KeyRow*> rows;
  for (const KeyRow& row : info.rows)
    if (inner_of(row) == nullptr) rows.push_back(&row);
  return rows;
}

bool is_inside(const KeyRow& row, std::string_view key) { return row.key.starts_with(std::string(key) + '.'); }

/// Returns the rows of one key of inner tables, from the first table that has most of them.
std::vector<const KeyRow*> rows_of_key(std::string_view key) {
  std::vector<const KeyRow*> most;
  for (const ScenarioTable& info : scenario_tables()) {
    std::vector<const KeyRow*> rows;
    for (const KeyRow& row : info.rows)
      if (is_inside(row, key)) rows.push_back(&row);
    if (rows.size() > most.size()) most = std::move(rows);
  }
  return most;
}

/// Returns the rows of inner tables; two that differ in name only (program, stiffness_program) are listed once.
std::vector<const KeyRow*> rows_of_inner(const InnerTables& inner) {
  const auto leaf = [](const KeyRow* row) { return row->key.substr(row->key.find('.')); };
  std::vector<const KeyRow*> all;
  for (const std::string_view key : inner.keys) {
    const std::vector<const KeyRow*> rows = rows_of_key(key);
    if (!std::ranges::equal(all, rows, {}, leaf, leaf)) all.insert(all.end(), rows.begin(), rows.end());
  }
  return all;
}

/// Lists the inner tables of a table, with links to their sections.
std::string inner_links(const ScenarioTable& info) {
  std::vector<std::string> links;
  for (const InnerTables& inner : inner_tables()) {
    std::vector<std::string> keys;
    for (const std::string_view key : inner.keys)
      if (std::ranges::any_of(info.rows, [&](const KeyRow& row) { return is_inside(row, key); }))
        keys.push_back(fmt::format("`{}`", key));
    if (!keys.empty())
      links.push_back(fmt::format("{} ({})", fmt::join(keys, ", "), link_to(inner.title, inner.title)));
  }
  return fmt::format("{}", fmt::join(links, "; "));
}

std::string section_of(const std::string& heading, std::string_view meaning) {
  return fmt::format("\n## {}\n\n{}\n\n", heading, meaning);
}

std::string key_table(const std::vector<const KeyRow*>& rows) {
  std::string text = "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n";
  for (const KeyRow* row : rows)
    text += fmt::format("| `{}` | {} | {} | {} | {} |\n", row->key, row->type(), default_text(*row), allowed_text(*row),
                        row->meaning);
  return text;
}

/// Lists links to all sections, by group.
std::string contents() {
  std::vector<std::pair<std::string_view, std::vector<std::string>>> groups;
  const auto links_of = [&](std::string_view title) -> std::vector<std::string>& {
    const auto found = std::ranges::find(groups, title, [](const auto& group) { return group.first; });
    return found != groups.end() ? found->second : groups.emplace_back(title, std::vector<std::string>()).second;
  };
  for (const ScenarioTable& info : scenario_tables())
    links_of(info.group).push_back(link_to(info.path.empty() ? "top level" : name_of(info), heading_of(info)));
  for (const InnerTables& inner : inner_tables())
    links_of("Inner tables of several tables").push_back(link_to(inner.title, inner.title));
  std::string text;
  for (const auto& [title, links] : groups) text += fmt::format("- {}: {}\n", title, fmt::join(links, ", "));
  return text;
}

}  // namespace

std::string float_in_toml(double value) {
  const std::string text = fmt::format("{}", value);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;  // 'n' of inf and nan
}

std::string resolved_toml(const Scenario& scenario) {
  Scenario copy = scenario;  // the table hands out pointers to fields that may be written
  std::string text = fmt::format("# {}, every default filled in.\n", scenario.name);
  for (const ScenarioTable& info : scenario_tables()) {
    const std::vector<std::string> names = info.named() ? info.names(scenario) : std::vector<std::string>{""};
    for (const std::string& name : names) text += table_text(info, name, copy);
  }
  return text;
}

std::string reference_markdown() {
  std::string text =
      "# Scenario reference\n\n"
      "This page lists every key of a scenario with its type, default, allowed values and meaning. A scenario is a "
      "[TOML](https://toml.io) file; keys that are not set take their defaults, and unknown keys are errors.\n\n"
      "Conventions: NAME is a name of your choice (letters, digits, `_`, `-`). Keys end in their unit; pairs such as "
      "`at_s` and `at_min` set one value in two units. The x axis points from anterior to posterior, y to the right, z "
      "from ventral to dorsal. Reference means undeformed (t = 0).\n\n" +
      contents() + "\n`plica reference` generates this page from the tables in `src/scenario/tables/`.\n";
  for (const ScenarioTable& info : scenario_tables()) {
    text += section_of(heading_of(info), info.meaning);
    if (const std::string inner = inner_links(info); !inner.empty())
      text += fmt::format("Inner tables: {}.\n\n", inner);
    text += key_table(own_rows(info));
    if (info.stem() == "expect")
      text += fmt::format("\n`[expect]` accepts: `{}`.\n", fmt::join(expectation_names(), "`, `"));
  }
  for (const InnerTables& inner : inner_tables())
    text += section_of(std::string(inner.title), inner.meaning) + key_table(rows_of_inner(inner));
  return text;
}

std::string KeyDifference::text() const {
  const auto shown = [](const std::string& value) { return value.empty() ? "missing" : value; };
  return fmt::format("{} was {} and is now {}", key, shown(a), shown(b));
}

std::vector<KeyDifference> scenario_differences(std::string_view a, std::string_view b) {
  std::map<std::string, KeyDifference> all;
  for (const auto& [key, value] : values_of(a)) all[key].a = value;
  for (const auto& [key, value] : values_of(b)) all[key].b = value;
  std::vector<KeyDifference> differences;
  for (const auto& [key, values] : all)
    if (values.a != values.b) differences.push_back({key, values.a, values.b});
  return differences;
}

}  // namespace plica
