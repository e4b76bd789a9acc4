// Output variables of steps and runs, one table row each: name, meaning, function, destination. The header and rows of
// series.csv, checkpoints, summary.json, names of [expect] and the table of docs/reference/measures.md follow from it.
// Columns belong to measure sets (measure_set.hpp).
#pragma once

#include <any>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <typeindex>
#include <vector>

#include "core/names.hpp"
#include "mechanics/model.hpp"

namespace plica {

struct AcceptedStep;
struct Observation;

/// What sets keep over a run, by the names of the sets that are measured.
using KeptBySet = std::map<std::string_view, std::any>;

/// Input of the columns of results after a step, with values that they share.
class ColumnInput {
 public:
  ColumnInput(const Model& of_model, const State& at_its_end, const AcceptedStep* accepted)
      : model(of_model), state(at_its_end), step(accepted) {}

  const Model& model;
  const State& state;              // at the end of the step
  const AcceptedStep* step;        // null for the reference state
  const std::any* kept = nullptr;  // of the column's set

  /// What the column's set keeps over the run.
  template <class Kept>
  [[nodiscard]] const Kept& of_set() const {
    return std::any_cast<const Kept&>(*kept);
  }
  /// Value that columns share, computed once per step; one function per type.
  template <class Value>
  [[nodiscard]] const Value& once(Value (*compute)(const ColumnInput&)) const {
    std::any& value = shared_[typeid(Value)];
    if (!value.has_value()) value = compute(*this);
    return std::any_cast<const Value&>(value);
  }

 private:
  mutable std::map<std::type_index, std::any> shared_;
};

/// Value of a column in summary.json.
enum class InSummary { nothing, last, largest, least, sum, whole_run };

struct Column {
  using OfStep = std::function<std::optional<double>(const ColumnInput&)>;
  using OfRun = std::function<std::optional<double>(std::span<const Observation> rows)>;

  std::string_view name;  // with its unit
  InSummary in_summary;
  std::string_view meaning;   // for docs/reference/measures.md, in Markdown
  OfStep of_step;             // value after a step, in series.csv; or
  OfRun of_run = {};          // value of the whole run, for the summary
  bool is_count = false;      // integer
  bool is_costly = false;     // takes over 1 % of a step
  std::string_view set = {};  // name of its measure set; filled by columns()
};

Column count(Column column);
Column costly(Column column);

/// Columns of all sets, in the order of series.csv.
std::span<const Column> columns();

/// Index of a column. Throws std::logic_error for an unknown name.
std::size_t column_index(std::string_view name);

/// Some of `columns()`, in their order.
using ColumnList = std::vector<const Column*>;

/// Whether a row has a place for every column, and integers for counts.
bool fits_columns(const Observation& row);

/// Value of a column in the summary from the rows of a whole run (reference state first).
std::optional<double> summary_value(const Column& column, std::span<const Observation> rows);

/// Tables of docs/reference/measures.md, in Markdown.
std::string measures_markdown();

}  // namespace plica
