#include "measure/observation.hpp"

#include <algorithm>
#include <cmath>

#include "measure/cells.hpp"

namespace plica {

Observer::Observer(const Model& model, FurrowSites sites, Watch watch)
    : model_(model),
      sites_(std::move(sites)),
      watch_(std::move(watch)),
      rest_lumen_volume_(lumen_volume(model.tissue, model.tissue.rest_positions)) {
  sites_.contractile.resize(model.tissue.cells.size(), false);  // where there are no sites
}

Observer::Observer(const Model& model, const Observer& other)
    : model_(model), sites_(other.sites_), watch_(other.watch_), rest_lumen_volume_(other.rest_lumen_volume_) {}

void Observer::observe_state(const State& state, Observation& row) const {
  const Tissue& tissue = model_.tissue;
  row.time_s = state.time_s;
  row.furrow = furrow_shape(tissue, sites_, state.positions);
  for (const double error : model_.volumes().relative_errors(state.positions))
    row.max_volume_error = std::max(row.max_volume_error, std::abs(error));
  if (rest_lumen_volume_)
    if (const auto volume = lumen_volume(tissue, state.positions))
      row.lumen_volume_ratio = *volume / *rest_lumen_volume_;
  row.max_shell_penetration_um = shell_penetration(model_, state.positions);
  for (const auto& element : tissue.elements)
    row.min_scaled_jacobian = std::min(row.min_scaled_jacobian, hex_scaled_jacobian(gather(state.positions, element)));
  if (sites_.vml.empty()) return;
  row.vml_displacement_um = mean_node_displacement(tissue, sites_.vml, state.positions);
  row.vce_displacement_um = mean_node_displacement(tissue, sites_.vce, state.positions);
  row.vml_apical_area_ratio = mean_apical_area_ratio(tissue, sites_.vml, state.positions);
  row.vce_apical_area_ratio = mean_apical_area_ratio(tissue, sites_.vce, state.positions);
}

void Observer::observe_monitors(const State& state, double wall_s, bool at_equilibrium, Observation& row) const {
  std::vector<Reading> readings;
  for (const Monitor& monitor : watch_.monitors) readings.push_back(read_monitor(monitor, {model_, state, wall_s}));
  for (const Reading& reading : readings) row.monitors.push_back(reading.number);
  row.criteria_met = watch_.stop.met(readings);
  row.is_over = watch_.stop.is_over(row.criteria_met.size(), at_equilibrium);
}

Observation Observer::observe(const AcceptedStep& step, double wall_s) const {
  Observation row;
  observe_state(step.state, row);
  observe_monitors(step.state, wall_s, step.at_equilibrium, row);
  row.max_node_speed_um_per_s = step.max_node_speed_um_per_s;
  row.step_s = step.duration_s;
  row.newton_iterations = step.report.newton_iterations;
  row.linear_solves = step.report.linear_solves;
  row.projection_sweeps = step.report.projection_sweeps;
  row.cubics = step.report.cubics;
  row.cubics_with_three_roots = step.report.cubics_with_three_roots;
  if (sites_.vml.empty()) return row;
  const auto speed = [&](const MonitoredCells& cells) {
    return mean_speed(model_.tissue, cells, step.state.velocities);
  };
  row.vml_speed_um_per_s = speed(sites_.vml);
  row.vce_speed_um_per_s = speed(sites_.vce);
  if (*row.vml_speed_um_per_s > 0) row.speed_ratio = *row.vce_speed_um_per_s / *row.vml_speed_um_per_s;
  return row;
}

Observation Observer::observe_rest(const State& state) const {
  Observation row;
  observe_state(state, row);
  observe_monitors(state, 0, false, row);
  return row;
}

SpeedHistory speed_history(const std::vector<Observation>& rows) {
  SpeedHistory history;
  double fastest_middle = 0;
  for (const Observation& row : rows) fastest_middle = std::max(fastest_middle, row.vml_speed_um_per_s.value_or(0));
  const auto lead = [](const Observation& row) { return *row.vce_speed_um_per_s - *row.vml_speed_um_per_s; };
  std::optional<std::size_t> peak;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!rows[i].vml_speed_um_per_s || *rows[i].vml_speed_um_per_s <= 0.01 * fastest_middle) continue;
    if (!peak || lead(rows[i]) > lead(rows[*peak])) peak = i;
  }
  if (!peak) return history;
  history.peak_ratio = rows[*peak].speed_ratio;
  history.peak_ratio_time_s = rows[*peak].time_s;
  if (lead(rows[*peak]) <= 0) return history;  // the ends never lead
  for (std::size_t i = *peak + 1; i < rows.size(); ++i) {
    const double before = lead(rows[i - 1]), after = lead(rows[i]);
    if (after > 0) continue;
    const double part = before > 0 ? before / (before - after) : 0;
    const auto between = [&](double a, double b) { return a + part * (b - a); };
    history.ends_lead_until_s = between(rows[i - 1].time_s, rows[i].time_s);
    history.vml_displacement_at_equal_speed_um =
        between(*rows[i - 1].vml_displacement_um, *rows[i].vml_displacement_um);
    history.vce_displacement_at_equal_speed_um =
        between(*rows[i - 1].vce_displacement_um, *rows[i].vce_displacement_um);
    break;
  }
  return history;
}

}  // namespace plica
