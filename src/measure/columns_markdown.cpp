// The tables of docs/reference/measures.md.
#include <fmt/format.h>

#include <array>

#include "measure/cell_columns.hpp"
#include "measure/columns.hpp"
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
      "### Each step: series.csv and summary.json\n\n"
      "`series.csv` has a row for the body at rest and one for every step. `summary.json` has one number of them: the "
      "last,\nlargest or smallest one, their sum, or one that only the whole run has.\n\n"
      "| measure | series | summary | meaning |\n|---|---|---|---|\n";
  for (const Column& column : columns())
    text += fmt::format("| `{}` | {} | {} | {} |\n", column.name, mark(column.in_series), in_summary(column),
                        column.meaning);
  return text;
}

std::string cell_table() {
  std::string text =
      "\n### Each cell: cells.csv and frames\n\n"
      "`cells.csv` has a row for every cell in every frame, up to 2000 cells (`output.cells_csv`).\n\n"
      "| measure | cells.csv | frames | meaning |\n|---|---|---|---|\n";
  for (const CellColumn& column : cell_columns())
    text += fmt::format("| `{}` | {} | {} | {} |\n", column.name, mark(column.in_csv),
                        mark(column.in_frames != InFrames::nothing), column.meaning);
  return text + "| `region_NAME` |  | x | 1 in cells of the region, 0 in others. |\n";
}

// Of columns that all go to one place.
template <class Columns>
std::string plain_table(const char* heading, const Columns& columns) {
  std::string text = fmt::format("\n### {}\n\n| measure | meaning |\n|---|---|\n", heading);
  for (const auto& column : columns) text += fmt::format("| `{}` | {} |\n", column.name, column.meaning);
  return text;
}

std::string quantity_table() {
  std::string text = "\n### Quantities of monitors\n\n| quantity | of each | unit | meaning |\n|---|---|---|---|\n";
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
