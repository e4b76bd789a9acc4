// Tables of docs/reference/measures.md.
#include <fmt/format.h>

#include <array>

#include "measure/cell_columns.hpp"
#include "measure/measure_set.hpp"
#include "measure/monitor.hpp"

namespace plica {
namespace {

const char* in_summary(const Column& column) {
  constexpr std::array words = {"", "last", "largest", "smallest", "sum", "of the run"};  // in the order of InSummary
  return words.at(static_cast<std::size_t>(column.in_summary));
}

const char* mark(bool is_there) { return is_there ? "x" : ""; }

const char* owner(QuantityInfo::Of of) {
  return of == QuantityInfo::Of::node ? "node" : of == QuantityInfo::Of::cell ? "cell" : "region";
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
  return text + "| `region_NAME` |  | x | 1 in cells of the region, else 0. |\n";
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
  for (const QuantityInfo& info : quantities())
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
