// [extrusion.NAME]: cells that leave the sheet. The rule that a simulation follows is made in simulation/controls.cpp.
#include "scenario/tables/table.hpp"

namespace plica {
namespace of_extrusion {

void check_extrusion(const std::string& table, ExtrusionInput& extrusion, const Scenario& scenario, Input& input) {
  for (const char* key : {"", ".apical_area_below_um2", ".basal_area_below_um2"})
    if (!input.sound(table + key)) return;
  if (!extrusion.apical_area_below_um2 && !extrusion.basal_area_below_um2)
    input.report(table, "has no effect", "set apical_area_below_um2 or basal_area_below_um2, for example to 5");
  if (!scenario.exchange.below_um && input.sound(table, "exchange"))
    input.report(table, "cells lose neighbours only by exchange", "set exchange.below_um, for example to 0.35");
}

}  // namespace of_extrusion

ScenarioTable extrusion_table() {
  using namespace of_extrusion;
  using X = ExtrusionInput;
  ScenarioTable info{"extrusion.*",
                     "Extrusion (T2): a small cell that has come down to three lateral faces leaves the sheet.",
                     "Activity"};
  const auto row = key_rows(info, &Scenario::extrusions);
  info.rows = {
      row("region", &X::region, anything, "Cells that may leave.", {.required = true}),
      row("apical_area_below_um2", &X::apical_area_below_um2, positive,
          "Apical area below which a cell leaves and no longer divides (µm²)."),
      row("basal_area_below_um2", &X::basal_area_below_um2, positive,
          "Likewise, basal area. If both are set, both must be below."),
  };
  check_each(info, &Scenario::extrusions, check_extrusion);
  return info;
}

}  // namespace plica
