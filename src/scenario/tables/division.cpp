// [division.NAME]: cells that divide. The rules that a simulation follows are made in simulation/controls.cpp.
#include "tissue/division.hpp"

#include "scenario/tables/table.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace of_division {

void check_division(const std::string& table, const DivisionInput& division, Input& input) {
  for (const char* key : {".at_s", ".when", ".threshold"})
    if (!input.sound(table) || !input.sound(table + key)) return;
  if (division.at_s && !division.when.empty())
    input.report(table + ".when", "conflicts with the division time, which is also set", "remove one of them");
  if (!division.at_s && division.when.empty())
    input.report(table, "no division time", "set at_s, at_min, or when with threshold");
  if (!division.when.empty() && !division.threshold)
    input.report(table + ".threshold", "is missing", "set threshold to the value at which cells divide");
  if (division.when.empty() && division.threshold)
    input.report(table + ".threshold", "is not used without `when`", "remove threshold, or set when");
  if (division.when.empty() && division.every_s > 0 && input.sound(table + ".every_s"))
    input.report(table + ".every_s", "is not used without `when`", "remove every_s, or set when");
}

void check_divisions(Scenario& scenario, Input& input) {
  for (const auto& [name, it] : scenario.divisions) check_division("division." + name, it, input);
  if (!scenario.divisions.empty() && input.sound("embryo.shape") && shape_of(scenario.embryo) == EmbryoShape::slice)
    input.report("embryo.shape", "cells of a slice cannot divide, since its cross-sections must stay alike",
                 "set shape to \"pill\", or remove [division]");
}

// Names keys that the shape has, for cells that cannot divide.
std::string how_to_divide(const Scenario& scenario, const Tissue& tissue) {
  const EmbryoInput& embryo = scenario.embryo;
  if (cell_between_layers(tissue)) return "use one layer of cells";
  if (embryo.elements_per_cell != EmbryoInput().elements_per_cell) return "set embryo.elements_per_cell to [1, 1, 1]";
  return "use a mesh with one element per cell, or with cells of polygons as `plica mesh` writes them";
}

void check_cells(const Scenario& scenario, const Tissue& tissue, Errors& errors) {
  if (const auto why = why_indivisible(tissue); why && !scenario.divisions.empty())
    errors.push_back(diagnostic_at(scenario, "division." + scenario.divisions.begin()->first,
                                   "the cells of this embryo cannot divide: " + *why, how_to_divide(scenario, tissue)));
}

}  // namespace of_division

ScenarioTable division_table() {
  using namespace of_division;
  using V = DivisionInput;
  ScenarioTable info{
      "division.*",
      "Cell division at a time or above a threshold, of polygons, or of grid cells with one element along and across.",
      "Activity"};
  const auto row = key_rows(info, &Scenario::divisions);
  info.rows = {
      row("region", &V::region, anything, "Cells that divide.", {.required = true}),
      row("at_s", &V::at_s, positive, "Time of division (s)."),
      row("at_min", &V::at_s, positive, "`at_s` in minutes.", {.instead_of = "at_s", .scale = 60}),
      row("when", &V::when, one_of(words::division_triggers),
          "Instead of a time: a cell divides when its apical area, volume or elongation (longer / shorter side) "
          "exceeds `threshold`, unless it is still growing."),
      row("threshold", &V::threshold, positive, "Threshold of `when`."),
      row("every_s", &V::every_s, not_negative,
          "Interval between checks of `threshold` (s); 0: after every step. Steps restart at a division, so a tissue "
          "that proliferates runs faster if many cells divide at once."),
      row("every_min", &V::every_s, not_negative, "`every_s` in minutes.", {.instead_of = "every_s", .scale = 60}),
      row("plane", &V::plane, one_of(words::division_planes),
          "Apico-basal division plane through midpoints of opposite cell sides: across the axis, along the midline, or "
          "across the longer side."),
      row("growth_s", &V::growth_s, not_negative, "Time in which daughters grow to final size (s)."),
      row("growth_min", &V::growth_s, not_negative, "`growth_s` in minutes.", {.instead_of = "growth_s", .scale = 60}),
      row("daughter_volume_ratio", &V::daughter_volume_ratio, between(0.25, 2),
          "Final daughter volume / mother volume."),
      row("max_generation", &V::max_generation, between(1, 30),
          "Last generation; default 1 with `when`, unlimited with a time."),
  };
  info.rules = check_divisions;
  info.check = check_cells;
  return info;
}

}  // namespace plica
