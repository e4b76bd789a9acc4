// The list of all scenario tables.
#include "scenario/schema.hpp"

namespace plica {

// Each in the file of its name, but: [elasticity.NAME] in elasticity.cpp; [vitelline], [dynamics] in
// surroundings.cpp; [stop], [stop.NAME], [expect] in monitor.cpp; [time], [measure], [furrow], [output] in run.cpp.
ScenarioTable top_table(), embryo_table(), region_table(), elasticity_table(), region_elasticity_table(),
    volume_table(), vitelline_table(), dynamics_table(), contraction_table(), cortex_table(), signal_table(),
    enclosed_table(), self_contact_table(), hold_table(), pressure_table(), foundation_table(), matrix_table(),
    ablation_table(), division_table(), exchange_table(), extrusion_table(), growth_table(), time_table(), stop_table(),
    criterion_table(), monitor_table(), measure_table(), furrow_table(), output_table(), expect_table();

std::span<const ScenarioTable> scenario_tables() {
  static const std::vector<ScenarioTable> tables = {
      top_table(),        embryo_table(),    region_table(),       elasticity_table(),  region_elasticity_table(),
      volume_table(),     vitelline_table(), dynamics_table(),     contraction_table(), cortex_table(),
      signal_table(),     enclosed_table(),  self_contact_table(), hold_table(),        pressure_table(),
      foundation_table(), matrix_table(),    ablation_table(),     division_table(),    exchange_table(),
      extrusion_table(),  growth_table(),    time_table(),         stop_table(),        criterion_table(),
      monitor_table(),    measure_table(),   furrow_table(),       output_table(),      expect_table()};
  return tables;
}

}  // namespace plica
