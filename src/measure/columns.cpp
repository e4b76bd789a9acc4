#include "measure/columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "measure/cell_columns.hpp"
#include "measure/measure_set.hpp"
#include "measure/observation.hpp"

namespace plica {

MeasureSet run_set(), fold_set(), furrow_set(), contact_set(), closing_set(), lumen_set(), enclosed_set(), shell_set(),
    perivitelline_set(), flanks_set(), bending_set(), projection_set(), shape_set(), neighbours_set();

namespace {

using enum InSummary;

// Fixed order in series.csv, for programs that read columns by number. Other columns follow, set by set.
constexpr std::string_view order =
    "time_s furrow_depth_um furrow_depth_below_lips_um lip_distance_um vml_speed_um_per_s vce_speed_um_per_s "
    "speed_ratio vml_displacement_um vce_displacement_um vml_apical_area_ratio vce_apical_area_ratio "
    "max_node_speed_um_per_s max_volume_error lumen_volume_ratio cells step_s newton_iterations linear_iterations "
    "self_intersections refused_steps vml_height_um min_apical_area_ratio min_corner_jacobian_ratio "
    "enclosed_volume_ratio yolk_pressure_Pa shell_fluid_um3 flank_volume_ratio contact_pairs min_contact_distance_um "
    "closed_length_ratio lips_closed active_work_nN_um stored_energy_nN_um dissipated_energy_nN_um "
    "energy_imbalance_ratio flank_section_area_ratio short_edges midline_waviness_um bending_error "
    "max_displacement_um mean_height_um tissue_volume_ratio ";

std::size_t place_of(const Column& column) { return order.find(std::string(column.name) + ' '); }

std::vector<Column> make_columns() {
  std::vector<Column> all;
  for (const MeasureSet& set : measure_sets())
    for (Column column : set.columns) {
      column.set = set.name;
      all.push_back(std::move(column));
    }
  std::ranges::stable_sort(all, {}, place_of);
  return all;
}

}  // namespace

bool fits_columns(const Observation& row) {
  const auto is_count = [](double number) { return std::abs(number) <= 1e9 && number == std::floor(number); };
  return row.values.size() == columns().size() && std::ranges::all_of(columns(), [&](const Column& column) {
           return !column.is_count || !row[column] || is_count(*row[column]);
         });
}

std::optional<double> summary_value(const Column& column, std::span<const Observation> rows) {
  if (column.of_run) return column.of_run(rows);
  if (column.in_summary == last) return rows.back()[column];
  std::optional<double> result;
  for (const Observation& row : rows) {
    const std::optional<double> value = row[column];
    if (!value) continue;
    if (!result)
      result = value;
    else if (column.in_summary == largest)
      result = std::max(*result, *value);
    else if (column.in_summary == least)
      result = std::min(*result, *value);
    else
      *result += *value;
  }
  return result;
}

std::span<const MeasureSet> measure_sets() {
  static const std::vector<MeasureSet> sets = {
      run_set(),   fold_set(),          furrow_set(), contact_set(), closing_set(),    lumen_set(), enclosed_set(),
      shell_set(), perivitelline_set(), flanks_set(), bending_set(), projection_set(), shape_set(), neighbours_set()};
  return sets;
}

bool begin(const MeasureSet& set, const Subject& subject, KeptBySet& kept) {
  std::any own = set.begin(subject);
  if (!own.has_value()) return false;
  kept[set.name] = std::move(own);
  return set.with.empty() || begin(*std::ranges::find(measure_sets(), set.with, &MeasureSet::name), subject, kept);
}

std::string set_remedy(std::string_view name) {
  const auto column = std::ranges::find(columns(), name, &Column::name);
  if (column == columns().end() || column->set.empty()) return "";
  const auto set = std::ranges::find(measure_sets(), column->set, &MeasureSet::name);
  return fmt::format("add \"{}\" to measure.sets (it needs {})", set->name, set->needs);
}

Column count(Column column) {
  column.is_count = true;
  return column;
}

Column costly(Column column) {
  column.is_costly = true;
  return column;
}

std::span<const Column> columns() {
  static const std::vector<Column> all = make_columns();
  return all;
}

std::size_t column_index(std::string_view name) {
  const auto found = std::ranges::find(columns(), name, &Column::name);
  if (found == columns().end()) throw std::logic_error("unknown column " + std::string(name));
  return static_cast<std::size_t>(found - columns().begin());
}

namespace {

const char* in_summary(const Column& column) {
  constexpr std::array words = {"", "last", "largest", "smallest", "sum", "of the run"};  // in the order of InSummary
  return words.at(static_cast<std::size_t>(column.in_summary));
}

const char* mark(bool is_there) { return is_there ? "x" : ""; }

const char* owner(Quantity::Of of) {
  return of == Quantity::Of::node ? "node" : of == Quantity::Of::region ? "region" : "cell";
}

std::string step_table() {
  std::string text =
      "### Sets\n\n"
      "`measure.sets` chooses what a run measures; by default what fits the tissue. `midline.csv` "
      "and\n`cross_section.csv` come with `fold`. What sets need:\n\n";
  for (const MeasureSet& set : measure_sets())
    if (!set.name.empty()) text += fmt::format("- `{}`: {}\n", set.name, set.needs);
  text +=
      "\n### Each step: series.csv and summary.json\n\n"
      "`series.csv` has one row for the reference state and one per accepted step; `summary.json` has one number per\n"
      "variable: last, largest, smallest, sum, or of the whole run.\n\n"
      "| variable | set | value | meaning |\n|---|---|---|---|\n";
  for (const Column& column : columns())
    text += fmt::format("| `{}` | {} | {}{}{} | {} |\n", column.name, column.set, column.of_step ? "series" : "",
                        column.of_step && column.in_summary != InSummary::nothing ? ", " : "", in_summary(column),
                        column.meaning);
  return text;
}

std::string cell_table() {
  std::string text =
      "\n### Each cell: cells.csv and frames\n\n"
      "`cells.csv` has one row per cell and snapshot, up to 2000 cells (`output.cells_csv`).\n\n"
      "| variable | cells.csv | frames | meaning |\n|---|---|---|---|\n";
  for (const CellColumn& column : cell_columns())
    text += fmt::format("| `{}` | {} | {} | {} |\n", column.name, mark(column.in_csv),
                        mark(column.in_frames != InFrames::nothing), column.meaning);
  return text +
         "| `region_NAME` |  | x | 1 in cells of the region, else 0. |\n"
         "| `signal_NAME` | x | x | Concentration of `[signal.NAME]`; only where there are signals. |\n";
}

// Table of columns that go to one file only.
template <class Columns>
std::string plain_table(const char* heading, const Columns& columns) {
  std::string text = fmt::format("\n### {}\n\n| variable | meaning |\n|---|---|\n", heading);
  for (const auto& column : columns) text += fmt::format("| `{}` | {} |\n", column.name, column.meaning);
  return text;
}

std::string quantity_table() {
  std::string text = "\n### Quantities of monitors\n\n| quantity | per | unit | meaning |\n|---|---|---|---|\n";
  for (const Quantity& info : quantities())
    text += fmt::format("| `{}` | {} | {} | {} |\n", info.name, owner(info.of),
                        info.unit.empty() ? "" : fmt::format("`{}`", info.unit), info.meaning);
  return text;
}

}  // namespace

std::string measures_markdown() {
  return step_table() + cell_table() + plain_table("Each node: frames", node_columns()) +
         plain_table("Cells of the ventral midline: midline.csv", midline_columns()) +
         plain_table("Cells of three cross-sections: cross_section.csv", section_columns()) +
         plain_table("Daughters, when they are born: lineage.csv", lineage_columns()) + quantity_table();
}

}  // namespace plica
