// Keys at the top of the file, [measure], [furrow] and [output]: what a run is called, measures and writes.
#include "measure/measure_set.hpp"
#include "scenario/tables/table.hpp"

namespace plica {
namespace {

std::vector<std::string_view> set_names() {
  std::vector<std::string_view> names = {"automatic"};
  for (const MeasureSet& set : measure_sets())
    if (!set.name.empty()) names.push_back(set.name);
  return names;
}

}  // namespace

ScenarioTable top_table() {
  using S = Scenario;
  ScenarioTable info{"", "Keys at the top of the file.", "General"};
  const RowsIn<S> row{"", [](S& scenario, const std::string&) -> S& { return scenario; }};
  info.rows = {
      row("format", &S::format, between(1, 1), "Version of the file format."),
      row("title", &S::title, anything, "One line for reports."),
      {"", "base", [](S&, const std::string&) -> Slot { return std::monostate(); }, anything,
       "Scenario to inherit from, key by key: built-in name, or path relative to this file. A new `embryo.shape` drops "
       "inherited `[embryo]` keys it does not use; a new region selector drops an inherited `face` or `array` that the "
       "shape lacks."},
  };
  return info;
}

ScenarioTable measure_table() {
  ScenarioTable info{"measure", "What is measured.", "Output"};
  const auto row = rows_in(info, &Scenario::measure);
  info.rows = {
      row("sets", &MeasureInput::sets, one_of(set_names()),
              "Sets of [output variables](measures.md#sets) to measure; `automatic`: those that fit the tissue.",
              {.may_be_empty = true}),
  };
  return info;
}

ScenarioTable furrow_table() {
  ScenarioTable info{"furrow", "Where the furrow is measured.", "Output"};
  const auto row = rows_in(info, &Scenario::furrow);
  info.rows = {
      row("region", &FurrowInput::region, anything,
             "Contractile cells that form the furrow; default the largest contracting region."),
      row("vce_cell", &FurrowInput::vce_cell, between(1, max_count),
             "Position of the near-end midline cell (VCE), counted from the ends; default 2, if present."),
  };
  info.regions = [](const Scenario& scenario, const TakeRegion& take) { take("furrow.region", scenario.furrow.region); };
  return info;
}

ScenarioTable output_table() {
  using O = OutputInput;
  ScenarioTable info{"output", "Files of a run.", "Output"};
  const auto row = rows_in(info, &Scenario::output);
  info.rows = {
      row("frame_every_s", &O::frame_every_s, not_negative,
             "Time between frames (snapshots; s); 0: first and last only."),
      row("frame_every_min", &O::frame_every_s, not_negative, "`frame_every_s` in minutes.",
             {.instead_of = "frame_every_s", .scale = 60}),
      row("cells_csv", &O::cells_csv, anything, "Write cells.csv; default up to 2000 cells."),
  };
  return info;
}

}  // namespace plica
