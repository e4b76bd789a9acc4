// Output variables of steps and runs, one table row each: name, meaning, function, destination. The header and rows of
// series.csv, checkpoints, summary.json, names of [expect] and the table of docs/reference/measures.md follow from it;
// a new variable is a new row and its function.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/names.hpp"
#include "measure/closing.hpp"
#include "measure/furrow.hpp"
#include "measure/speed_history.hpp"

namespace plica {

struct AcceptedStep;
struct Observation;

/// Measures of the reference state, computed once.
struct RestMeasures {
  std::optional<double> lumen_volume_um3, flank_volume_um3, flank_section_um2;
  double tissue_volume_um3 = 0;
};

/// Data shared by the variables of a step, computed once.
struct MeasuredStep {
  MeasuredStep(const Model& of_model, const FurrowSites& at_sites, const RestMeasures& at_rest, const State& at_its_end,
               const AcceptedStep* accepted);

  const Model& model;
  const FurrowSites& sites;
  const RestMeasures& rest;
  const State& state;        // at the end of the step
  const AcceptedStep* step;  // null for the reference state
  FurrowShape furrow;
  SpeedRow speeds;
  std::optional<ContactState> contact_state;
  std::optional<Enclosed> enclosed;
};

/// Value of a column in summary.json.
enum class InSummary { nothing, last, largest, least, sum, whole_run };

struct Column {
  using OfStep = std::function<std::optional<double>(const MeasuredStep&)>;
  using OfRun = std::function<std::optional<double>(std::span<const Observation> rows)>;

  std::string_view name;  // with its unit
  bool in_series;
  InSummary in_summary;
  std::string_view meaning;    // for docs/reference/measures.md, in Markdown
  OfStep of_step;              // value after a step; or
  OfRun of_run = {};           // value of the whole run, for the summary
  bool is_count = false;       // integer
  bool of_projection = false;  // null in the summary unless the run projects volumes
  bool is_costly = false;      // takes over 1 % of a step; not used by other columns
};

/// All columns, in the order of series.csv.
std::span<const Column> columns();

/// Index of a column. Throws std::logic_error for an unknown name.
std::size_t column_index(std::string_view name);

/// Names of the columns of series.csv, without monitors.
std::vector<std::string> series_names();

/// Columns of summary.json, in its order.
std::vector<const Column*> summary_columns();

/// Values of these columns from the rows of a whole run (reference state first).
std::vector<std::pair<const Column*, std::optional<double>>> summary_values(std::span<const Observation> rows);

/// Tables of docs/reference/measures.md, in Markdown.
std::string measures_markdown();

}  // namespace plica
