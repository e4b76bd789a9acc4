// The measures of a step and of a run, one row of a table each: name, meaning, who computes it, where it goes. The
// header and rows of series.csv, the rows of a checkpoint, the values of summary.json, the names that [expect] knows
// and the table in docs/reference/measures.md come from it: a new measure is a new row, and the function that the row
// names.
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

/// What is measured of the body at rest, once.
struct RestMeasures {
  std::optional<double> lumen_volume_um3, flank_volume_um3, flank_section_um2;
};

/// What the measures of a step are made from. What several of them need is made once.
struct MeasuredStep {
  MeasuredStep(const Model& of_model, const FurrowSites& at_sites, const RestMeasures& at_rest, const State& at_its_end,
               const AcceptedStep* accepted);

  const Model& model;
  const FurrowSites& sites;
  const RestMeasures& rest;
  const State& state;        // at its end
  const AcceptedStep* step;  // null for the body at rest, before the first
  FurrowShape furrow;
  SpeedRow speeds;
  std::optional<Touching> touching;
  std::optional<Enclosed> enclosed;
};

/// What summary.json has of a column.
enum class InSummary { nothing, last, largest, least, sum, whole_run };

struct Column {
  using OfStep = std::function<std::optional<double>(const MeasuredStep&)>;
  using OfRun = std::function<std::optional<double>(std::span<const Observation> rows)>;

  std::string_view name;  // with its unit
  bool in_series;
  InSummary in_summary;
  std::string_view meaning;    // for docs/reference/measures.md, in Markdown
  OfStep of_step;              // its value after a step; or
  OfRun of_run = {};           // its value in the summary, of the run as a whole
  bool is_count = false;       // a whole number
  bool of_projection = false;  // null in the summary of a run that does not project volumes
  bool is_costly = false;      // takes more than a hundredth of a step; nothing else is made from it
};

/// All of them, in the order of series.csv.
std::span<const Column> columns();

/// The place of a column in the table. std::logic_error when there is none of that name.
std::size_t column_index(std::string_view name);

/// Those of series.csv, monitors apart.
std::vector<std::string> series_names();

/// The columns that summary.json has, in its order.
std::vector<const Column*> summary_columns();

/// What the summary has of each of those, of the rows of a whole run (the one at rest first).
std::vector<std::pair<const Column*, std::optional<double>>> summary_values(std::span<const Observation> rows);

/// The tables of docs/reference/measures.md, in Markdown.
std::string measures_markdown();

}  // namespace plica
