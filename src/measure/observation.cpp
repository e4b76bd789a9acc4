#include "measure/observation.hpp"

#include "measure/measure_set.hpp"

namespace plica {

Observer::Observer(const Model& model, Watch watch) : watch_(std::move(watch)) {
  begin(measure_sets().front(), {model}, watch_.sets);
  columns_ = all_columns();
  leave_out([&](const Column& column) { return !watch_.sets.contains(column.set); });
}

Observation Observer::row_of(const Moment& moment, const AcceptedStep* step) const {
  Observation row;
  MeasuredStep measured(moment.model, moment.state, step);
  for (const Column* column : columns_) {
    if (!column->of_step) continue;
    measured.kept = &watch_.sets.at(column->set);
    row.values[static_cast<std::size_t>(column - plica::columns().data())] = column->of_step(measured);
  }

  std::vector<Reading> readings;
  for (const Monitor& monitor : watch_.monitors) readings.push_back(read_monitor(monitor, moment));
  for (const Reading& reading : readings) row.monitors.push_back(reading.number);
  row.criteria_met = watch_.stop.met(readings);
  row.is_over = watch_.stop.is_over(row.criteria_met.size(), step != nullptr && step->at_equilibrium);
  return row;
}

Observation Observer::observe(const Model& model, const AcceptedStep& step, double wall_s) const {
  return row_of({model, step.state, wall_s}, &step);
}

Observation Observer::observe_rest(const Model& model, const State& state) const {
  return row_of({model, state, 0}, nullptr);
}

void Observer::follow_division(const Tissue& tissue, const Division& division) {
  for (const MeasureSet& set : measure_sets())
    if (const auto kept = watch_.sets.find(set.name); kept != watch_.sets.end() && set.follow_division)
      set.follow_division(kept->second, tissue, division);
}

}  // namespace plica
