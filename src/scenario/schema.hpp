// Tables of a scenario and their keys: type, default, allowed values, meaning, and the field that a key fills. Loading,
// `--set`, suggestions, the resolved scenario and the reference page use these rows, so a new key is one new row. Each
// table is in a file of tables/ with its rules and what it adds to a model; tables/all.cpp lists them.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scenario/scenario.hpp"

namespace plica {

struct Acting;
struct Diagnostic;
struct Input;
struct Model;
struct Origin;
struct Tissue;

/// Field that a row fills; monostate for `base`, which only the loader reads.
using Slot =
    std::variant<std::monostate, int*, double*, bool*, std::string*, std::optional<int>*, std::optional<double>*,
                 std::optional<bool>*, std::optional<Range>*, std::array<int, 3>*, std::vector<int>*,
                 std::vector<double>*, std::vector<std::string>*, std::map<std::string, double>*>;

/// Allowed values. Bounds apply to each number of a list, words to each text of a list.
struct Allowed {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_included = true;
  bool high_included = true;
  std::vector<std::string_view> words = {};  // empty: any text
  std::string_view word_for_none = {};       // word for an optional number without a value

  [[nodiscard]] bool contains(double value) const;
  /// Description, such as "> 0", "1 to 8", "pill | sphere"; empty if any value is allowed.
  [[nodiscard]] std::string text() const;
};

struct KeyOptions {
  std::string_view instead_of = {};  // key of the same table that has the primary unit
  double scale = 1;                  // unit of the key / unit of the field
  bool required = false;
  bool is_path = false;                       // relative to the file that sets it
  bool may_be_empty = false;                  // lists: an empty list is meaningful
  std::vector<std::string_view> shapes = {};  // embryo shapes that use it; empty: all
};

struct KeyRow {
  std::string_view table;  // "embryo"; "contraction.*" for named tables; "" at the top level
  std::string_view key;    // a dot marks a key of an inner table, such as "profile.shape"
  std::function<Slot(Scenario&, const std::string& name)> field;  // creates the named table if needed
  Allowed allowed;
  std::string_view meaning;
  KeyOptions options = {};

  [[nodiscard]] std::string type() const;      // "number", "3 integers", ...
  [[nodiscard]] std::string expected() const;  // type and allowed values, such as "a number > 0"
  [[nodiscard]] std::string remedy() const;    // such as "set end_s to a number > 0"
  [[nodiscard]] bool used_by(std::string_view shape) const;
};

using TakeNodes = std::function<void(const std::string& table, const std::vector<bool>& nodes)>;
using TakeRegion = std::function<void(const std::string& address, const std::string& region)>;

/// One table, or all named tables of one kind. Functions that a table does not need are empty.
struct ScenarioTable {
  std::string_view path;
  std::string_view meaning;
  std::string_view group;  // heading in the contents of the reference page
  std::vector<KeyRow> rows = {};
  std::function<std::vector<std::string>(const Scenario&)> names = {};  // named tables only
  /// Names the regions that it refers to, which may be empty.
  std::function<void(const Scenario&, const TakeRegion&)> regions = {};
  /// Checks rules between keys and sets defaults that depend on other keys.
  std::function<void(Scenario&, Input&)> rules = {};
  /// Checks what depends on the tissue, whose regions are resolved.
  std::function<void(const Scenario&, const Tissue&, std::vector<Diagnostic>&)> check = {};
  /// Adds laws, constraints and fixed nodes to a model, in the order of tables: that of laws in sums and states.
  std::function<void(const Scenario&, const Origin&, Model&)> build = {};
  /// Names the nodes that it fixes; mirror planes require them, and regions of tables that act, to be symmetric.
  std::function<void(const Scenario&, const Tissue&, const TakeNodes&)> held_nodes = {};
  bool mirrored_regions = false;  // mirror planes require its regions to be symmetric, though it does not act
  /// Lists the tables that act on cells by strengths (CellPattern), passive ones too.
  std::function<void(const Scenario&, std::vector<Acting>&)> acting = {};

  [[nodiscard]] bool named() const { return path.ends_with(".*"); }
  [[nodiscard]] std::string_view stem() const { return named() ? path.substr(0, path.size() - 2) : path; }
};

/// Inner tables that are documented once, in a section of their own.
struct InnerTables {
  std::string_view title;
  std::vector<std::string_view> keys;  // of the tables that have them: "profile"
  std::string_view meaning;
};

std::span<const ScenarioTable> scenario_tables();         // in the order of a resolved scenario
std::span<const KeyRow> rows_of(std::string_view table);  // rows of one table, in order
std::span<const InnerTables> inner_tables();              // in the order of the reference page
const KeyRow* row_of_key(std::string_view dotted);        // "contraction.apical.region"; null if unknown
std::span<const std::string_view> expectation_names();    // names allowed in [expect]

void reset_to_default(const KeyRow& row, Scenario& scenario, const std::string& name);

}  // namespace plica
