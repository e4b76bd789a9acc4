#include "scenario/read_layer.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <sstream>

#include "scenario/builtin.hpp"
#include "scenario/suggest.hpp"

namespace plica {
namespace {

using Problem = std::optional<std::string>;

std::string in_toml(const toml::node& node) {
  std::ostringstream stream;
  if (node.is_table()) return "a table";
  if (node.is_array()) return "a list";
  node.visit([&](const auto& value) {
    if constexpr (toml::is_string<decltype(value)>) {
      stream << '"' << value.get() << '"';
    } else if constexpr (toml::is_floating_point<decltype(value)>) {
      stream << fmt::format("{}", value.get());  // the shortest form, most likely as written
    } else if constexpr (toml::is_value<decltype(value)>) {
      stream << value;
    }
  });
  return stream.str();
}

// Keys of a table inside another.
std::vector<std::string_view> keys_below(std::string_view table, const std::string& inner) {
  std::vector<std::string_view> keys;
  for (const KeyRow& row : rows_of(table))
    if (row.key.starts_with(inner + ".")) keys.push_back(row.key.substr(inner.size() + 1));
  return keys;
}

Problem wrong_type(const toml::node& node) { return fmt::format("{} has the wrong type", in_toml(node)); }

Problem read(const toml::node& node, const KeyRow& row, int& target) {
  if (node.is_floating_point()) return fmt::format("{} is not an integer", in_toml(node));
  const auto value = node.value_exact<std::int64_t>();
  if (!value) return wrong_type(node);
  const bool fits = *value >= std::numeric_limits<int>::min() && *value <= std::numeric_limits<int>::max();
  if (!fits || !row.allowed.contains(static_cast<double>(*value))) return fmt::format("{} is out of range", *value);
  target = static_cast<int>(*value);
  return {};
}

Problem read(const toml::node& node, const KeyRow& row, double& target) {
  if (!node.is_number()) return wrong_type(node);
  const double value = *node.value<double>();
  if (!std::isfinite(value)) return fmt::format("{} is not a finite number", value);
  if (!row.allowed.contains(value)) return fmt::format("{} is out of range", in_toml(node));
  target = value * row.options.scale;
  return {};
}

Problem read(const toml::node& node, const KeyRow&, bool& target) {
  const auto value = node.value_exact<bool>();
  if (!value) return wrong_type(node);
  target = *value;
  return {};
}

Problem read(const toml::node& node, const KeyRow& row, std::string& target) {
  const auto value = node.value_exact<std::string>();
  if (!value) return wrong_type(node);
  if (value->empty()) return "the text is empty";
  const auto& words = row.allowed.words;
  if (!words.empty() && std::ranges::find(words, *value) == words.end())
    return fmt::format("\"{}\" is unknown", *value);
  target = *value;
  return {};
}

/// Reads `node` as a list and passes each item to `take`.
template <class Item, class Take>
Problem read_items(const toml::node& node, const KeyRow& row, const Take& take) {
  const toml::array* items = node.as_array();
  if (items == nullptr) return wrong_type(node);
  if (items->empty() && !row.options.may_be_empty) return "the list is empty";
  for (const toml::node& item : *items) {
    Item value{};
    if (Problem problem = read(item, row, value)) return problem;
    take(value);
  }
  return {};
}

template <class Item>
Problem read(const toml::node& node, const KeyRow& row, std::vector<Item>& target) {
  target.clear();
  return read_items<Item>(node, row, [&](const Item& item) { target.push_back(item); });
}

template <class Item, std::size_t n>
Problem read(const toml::node& node, const KeyRow& row, std::array<Item, n>& target) {
  std::vector<Item> items;
  if (Problem problem = read(node, row, items)) return problem;
  if (items.size() != n) return fmt::format("{} values are given, but {} are required", items.size(), n);
  if (std::is_same_v<std::array<Item, n>, Range> && items.front() > items.back()) return "low is above high";
  std::ranges::copy(items, target.begin());
  return {};
}

// Adds to what a base gave, as keys of tables do.
Problem read(const toml::node& node, const KeyRow& row, std::map<std::string, double>& target) {
  const toml::table* numbers = node.as_table();
  if (numbers == nullptr) return wrong_type(node);
  for (const auto& [key, number] : *numbers)
    if (Problem problem = read(number, row, target[std::string(key.str())]))
      return fmt::format("{}: {}", key.str(), *problem);
  return {};
}

template <class Value>
Problem read(const toml::node& node, const KeyRow& row, std::optional<Value>& target) {
  const std::string_view none = row.allowed.word_for_none;
  const auto word = node.value_exact<std::string>();
  if (!none.empty() && word && *word == none) {
    target.reset();
    return {};
  }
  Value value{};
  Problem problem = read(node, row, value);
  if (!problem) target = value;
  return problem;
}

Problem read(const toml::node& node, const KeyRow& row, const Slot& slot) {
  return std::visit(
      [&](auto target) -> Problem {
        if constexpr (std::is_same_v<decltype(target), std::monostate>) {
          std::string text;
          return read(node, row, text);
        } else {
          return read(node, row, *target);
        }
      },
      slot);
}

/// Returns what to set the key to, with the nearest word for a misspelt one.
std::string remedy_for(const toml::node& node, const KeyRow& row) {
  const std::vector<std::string> words(row.allowed.words.begin(), row.allowed.words.end());
  std::string word = node.value_or(std::string());
  if (const toml::array* items = node.as_array())
    for (const toml::node& item : *items)
      if (const auto text = item.value<std::string>(); word.empty() && text && std::ranges::count(words, *text) == 0)
        word = *text;
  const auto nearest = nearest_name(word, words);
  return row.remedy() + (nearest ? fmt::format(" (nearest match: \"{}\")", *nearest) : "");
}

std::string joined(const std::string& path, std::string_view key) {
  return path.empty() ? std::string(key) : fmt::format("{}.{}", path, key);
}

/// Replacement for an unknown key, and the address that was probably meant.
struct Suggestion {
  std::string remedy;
  std::string meant;
};

Suggestion suggest_key(const std::string& table, const std::string& path, const std::string& key) {
  std::vector<std::string> known, same_stem;
  for (const KeyRow& row : rows_of(table)) {
    // For inner tables the name is enough unless the key is inside one.
    const std::size_t dot = key.find('.') == std::string::npos ? row.key.find('.') : std::string_view::npos;
    const std::string name(row.key.substr(0, dot));
    if (known.empty() || known.back() != name) known.push_back(name);
    if (without_unit(row.key) == without_unit(key)) same_stem.push_back(fmt::format("\"{}\"", row.key));
  }
  if (!same_stem.empty())
    return {fmt::format("use {} and convert the value to that unit", fmt::join(same_stem, " or ")), path};
  if (table.empty()) {
    for (const ScenarioTable& info : scenario_tables()) {
      if (!info.path.empty() && known.back() != info.stem()) known.emplace_back(info.stem());
    }
  }
  if (const auto nearest = nearest_name(key, known)) return {did_you_mean(key, known), table.empty() ? *nearest : path};
  for (const ScenarioTable& info : scenario_tables())
    if (std::ranges::any_of(info.rows, [&](const KeyRow& row) { return row.key == key; }))
      return {fmt::format("move it to [{}{}]", info.stem(), info.named() ? ".NAME" : ""), ""};
  return {did_you_mean(key, known), path};
}

class Reader {
 public:
  Reader(const Layer& layer, Scenario& scenario, Input& input) : layer_(layer), scenario_(scenario), input_(input) {}

  void read_top(const toml::table& document) {
    for (const auto& [key, node] : document) {
      const ScenarioTable* info = table_with_stem(key.str());
      if (info == nullptr) {
        read_key("", "", "", key, node);
      } else if (const toml::table* table = as_table(node, key, std::string(key.str()), "a table")) {
        note(std::string(key.str()), std::string(key.str()), key, nullptr);
        info->named() ? read_named(*info, *table) : read_plain(*info, *table);
      }
    }
  }

 private:
  /// Returns the table with this stem; if there are two, the plain one, or with `named` the one of named tables.
  static const ScenarioTable* table_with_stem(std::string_view stem, bool named = false) {
    for (const ScenarioTable& info : scenario_tables()) {
      if (!info.path.empty() && info.stem() == stem && (!named || info.named())) return &info;
    }
    return nullptr;
  }

  /// Reads the keys of a table and its named tables, if any: [stop] and [stop.NAME].
  void read_plain(const ScenarioTable& info, const toml::table& table) {
    const std::string path(info.path);
    const ScenarioTable* inner = table_with_stem(info.stem(), true);
    for (const auto& [key, node] : table) {
      const std::string_view word = key.str();
      const bool is_key = std::ranges::any_of(info.rows, [&](const KeyRow& row) { return row.key == word; });
      if (inner != nullptr && node.is_table() && !is_key) {
        read_named_table(*inner, std::string(word), key, node);
      } else {
        read_key(path, "", "", key, node);
      }
    }
  }

  int line_of(const toml::key& key) const { return layer_.has_lines ? static_cast<int>(key.source().begin.line) : 0; }

  void report(const toml::key& key, const std::string& written, std::string problem, std::string remedy) {
    input_.diagnostics.push_back({layer_.file, line_of(key), written, std::move(problem), std::move(remedy)});
  }

  void note(const std::string& address, const std::string& written, const toml::key& key, const KeyRow* row) {
    input_.places[address] = {layer_.file, line_of(key), layer_.number, written, row};
  }

  const toml::table* as_table(const toml::node& node, const toml::key& key, const std::string& written,
                              const std::string& expected) {
    if (node.is_table()) return node.as_table();
    report(key, written, fmt::format("{} is not a table", in_toml(node)), "write " + expected);
    input_.doubtful.insert(written);
    return nullptr;
  }

  void read_named(const ScenarioTable& info, const toml::table& tables) {
    for (const auto& [key, node] : tables) {
      const std::string name(key.str());
      const toml::table* inner = node.as_table();
      const bool of_monitor = info.stem() == "expect" && inner != nullptr && !inner->empty() &&
                              std::ranges::all_of(*inner, [](const auto& it) { return it.second.is_table(); });
      if (!of_monitor) {
        read_named_table(info, name, key, node);
        continue;
      }
      for (const auto& [column, table] : *inner)  // floor.position_um = { ... }
        read_named_table(info, joined(name, column.str()), column, table);
    }
  }

  void read_named_table(const ScenarioTable& info, const std::string& name, const toml::key& key,
                        const toml::node& node) {
    const std::string path = joined(std::string(info.stem()), name);
    if (!is_known_name(info, name, key, path)) return;
    if (info.stem() == "expect" && node.is_value()) {
      report(key, path, fmt::format("{} has no tolerance", in_toml(node)),
             "write { value = ..., within_percent = ... } or { value = ..., within = ... }");
      return;
    }
    const toml::table* table = as_table(node, key, path, "a table");
    if (table == nullptr) return;
    note(path, path, key, nullptr);
    info.rows.front().field(scenario_, name);  // so that a table without keys exists
    read_keys(std::string(info.path), name, "", *table);
  }

  bool is_known_name(const ScenarioTable& info, const std::string& name, const toml::key& key,
                     const std::string& path) {
    if (info.stem() == "expect") {
      if (name.find('.') != std::string::npos) return true;  // a monitor's, which may not have been read yet
      const auto names = expectation_names();
      if (std::ranges::find(names, name) != names.end()) return true;
      report(key, path, "unknown output variable", did_you_mean(name, {names.begin(), names.end()}));
      return false;
    }
    if (!is_plain_name(name)) {
      report(key, path, "is not a valid name", "use letters, digits, \"_\" and \"-\" only");
      input_.doubtful.insert(path);
      return false;
    }
    if (info.stem() == "region" && name == "all") {
      report(key, path, "\"all\" is predefined as every cell", "rename the region");
      return false;
    }
    return true;
  }

  void read_keys(const std::string& table, const std::string& name, const std::string& prefix,
                 const toml::table& values) {
    for (const auto& [key, node] : values) read_key(table, name, prefix, key, node);
  }

  void read_key(const std::string& table, const std::string& name, const std::string& prefix, const toml::key& key,
                const toml::node& node) {
    const std::string row_key = prefix + std::string(key.str());
    const std::string path = name.empty() ? table : joined(table.substr(0, table.find('.')), name);
    const std::string written = joined(path, row_key);
    for (const KeyRow& row : rows_of(table)) {
      if (row.key == row_key) return read_value(row, name, path, written, key, node);
      if (row.key.starts_with(row_key + ".")) {
        const toml::table* inner =
            as_table(node, key, written, fmt::format("a table of {}", fmt::join(keys_below(table, row_key), ", ")));
        if (inner == nullptr) return;
        note(written, written, key, nullptr);
        return read_keys(table, name, row_key + ".", *inner);
      }
    }
    Suggestion suggestion = suggest_key(table, path, row_key);
    report(key, written, table.empty() && node.is_table() ? "unknown table" : "unknown key", suggestion.remedy);
    input_.doubtful.insert(suggestion.meant);
  }

  void read_value(const KeyRow& row, const std::string& name, const std::string& path, const std::string& written,
                  const toml::key& key, const toml::node& node) {
    const std::string address = joined(path, row.options.instead_of.empty() ? row.key : row.options.instead_of);
    if (const KeyPlace* before = input_.place(address); before != nullptr && before->row != &row) {
      if (before->layer == layer_.number) {
        report(key, written, fmt::format("conflicts with {}, which is also set", before->written),
               "remove one of them");
        input_.doubtful.insert(address);
      }
      reset_to_default(*before->row, scenario_, name);
    }
    note(address, written, key, &row);
    const Slot slot = row.field(scenario_, name);
    if (Problem problem = read(node, row, slot)) {
      report(key, written, *problem, remedy_for(node, row));
      input_.doubtful.insert(address);
    } else if (row.options.is_path) {
      // On the command line, paths are relative to the working directory.
      std::string& file = *std::get<std::string*>(slot);
      if (is_builtin_table(file)) return;
      const std::filesystem::path folder = layer_.has_lines ? std::filesystem::path(layer_.file).parent_path() : "";
      file = std::filesystem::absolute(folder / file).lexically_normal().string();
    }
  }

  const Layer& layer_;
  Scenario& scenario_;
  Input& input_;
};

}  // namespace

bool is_plain_name(std::string_view name) {
  return !name.empty() &&
         std::ranges::all_of(name, [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '-'; });
}

void read_layer(const toml::table& table, const Layer& layer, Scenario& scenario, Input& input) {
  Reader(layer, scenario, input).read_top(table);
}

}  // namespace plica
