// [extrusion.NAME]: cells that leave the sheet. The rule that a simulation follows is made in simulation/controls.cpp.
#include "scenario/tables/table.hpp"

namespace plica {
namespace {

void check_extrusion(const std::string& table, ExtrusionInput&, const Scenario& scenario, Input& input) {
  if (!scenario.exchange.below_um && input.sound(table, "exchange"))
    input.report(table, "cells lose neighbours only by exchange", "set exchange.below_um, for example to 0.35");
}

}  // namespace

ScenarioTable extrusion_table() {
  using X = ExtrusionInput;
  ScenarioTable info{"extrusion.*",
                     "Extrusion (T2): a small cell that has come down to three lateral faces leaves the sheet.",
                     "Activity"};
  const auto row = key_rows(info, &Scenario::extrusions);
  info.rows = {
      row("region", &X::region, anything, "Cells that may leave.", {.required = true}),
      row("apical_area_below_um2", &X::apical_area_below_um2, positive,
          "Apical area below which a cell leaves and no longer divides (µm²).", {.required = true}),
  };
  check_each(info, &Scenario::extrusions, check_extrusion);
  return info;
}

}  // namespace plica
