// The one table of every rule of a scenario: key, type, default, what is allowed, meaning, and the field it fills.
// Loading, `--set`, the nearest known name, the resolved scenario and the reference page all run off it, so that a new
// key is one new row. Rules between several keys are in validate.cpp.
#pragma once

#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/scenario.hpp"

namespace plica {

/// The field that a row fills; monostate for `base`, which only the loader reads.
using Slot = std::variant<std::monostate, int*, double*, bool*, std::string*, std::optional<int>*,
                          std::optional<double>*, std::optional<bool>*, std::optional<Range>*, std::array<int, 3>*,
                          std::vector<int>*, std::vector<double>*, std::vector<std::string>*>;

/// What a value may be. Bounds hold for each number of a list, words for each text of one.
struct Allowed {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true;
  bool high_included = true;
  std::vector<std::string_view> words = {};  // empty: any text
  std::string_view word_for_none = {};       // how an optional number says that it has none

  [[nodiscard]] bool contains(double value) const;
  /// As in "> 0", "1 to 8", "pill | sphere"; empty where anything goes.
  [[nodiscard]] std::string text() const;
};

struct RowOptions {
  std::string_view instead_of = {};  // the key of the same table that this one stands in for
  double scale = 1;                  // unit of the key / unit of the field
  bool required = false;
  bool is_path = false;                       // relative to the file that gives it
  bool may_be_empty = false;                  // a list: has a meaning without items
  std::vector<std::string_view> shapes = {};  // embryo shapes that use it; empty: all
};

struct Row {
  std::string_view table;  // "embryo"; "contraction.*" where the tables are named; "" at the top
  std::string_view key;    // a dot in it means a table within the table
  std::function<Slot(Scenario&, const std::string& name)> field;  // makes the named table if need be
  Allowed allowed;
  std::string_view meaning;
  RowOptions options = {};

  [[nodiscard]] std::string type() const;      // "number", "3 integers", ...
  [[nodiscard]] std::string expected() const;  // type and what is allowed, as in "a number > 0"
  [[nodiscard]] bool used_by(std::string_view shape) const;
};

struct TableInfo {
  std::string_view path;
  std::string_view meaning;
  std::function<std::vector<std::string>(const Scenario&)> names;  // of a named table; empty otherwise

  [[nodiscard]] bool named() const { return path.ends_with(".*"); }
  [[nodiscard]] std::string_view stem() const { return named() ? path.substr(0, path.size() - 2) : path; }
};

std::span<const Row> schema();
std::span<const TableInfo> schema_tables();               // in the order in which a scenario is written
std::vector<const Row*> rows_of(std::string_view table);  // of one table, in order
const Row* row_of_key(std::string_view dotted);           // "contraction.apical.region"; null where there is none
std::span<const std::string_view> expectation_names();    // what [expect] may name

/// Gives the row's field of `scenario` its default.
void reset_to_default(const Row& row, Scenario& scenario, const std::string& name);

}  // namespace plica
