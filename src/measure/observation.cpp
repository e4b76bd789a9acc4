#include "measure/observation.hpp"

#include "measure/measure_set.hpp"

namespace plica {

Observer::Observer(const Model& model, MeasurePlan measure_plan) : plan_(std::move(measure_plan)) {
  begin(measure_sets().front(), {model}, plan_.sets);
  for (const Column& column : plica::columns())
    if (plan_.sets.contains(column.set)) columns_.push_back(&column);
}

Observation Observer::observe(const Moment& moment, const AcceptedStep* step) const {
  Observation row;
  ColumnInput measured(moment.model, moment.state, step);
  for (const Column* column : columns_) {
    if (!column->of_step) continue;
    measured.kept = &plan_.sets.at(column->set);
    row[*column] = column->of_step(measured);
  }

  std::vector<Reading> readings;
  for (const Monitor& monitor : plan_.monitors) readings.push_back(read_monitor(monitor, moment));
  for (const Reading& reading : readings) row.monitors.push_back(reading.number);
  row.criteria_met = plan_.stop.met(readings);
  row.is_over = plan_.stop.is_over(row.criteria_met.size(), step != nullptr && step->at_equilibrium);
  return row;
}

void Observer::follow_division(const Tissue& tissue, const TissueChange& change) {
  for (const MeasureSet& set : measure_sets())
    if (const auto kept = plan_.sets.find(set.name); kept != plan_.sets.end() && set.follow_division)
      set.follow_division(kept->second, tissue, change);
}

}  // namespace plica
