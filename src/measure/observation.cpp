#include "measure/observation.hpp"

#include "measure/cells.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

// Lumen volume; empty for an open sheet, also for a slice, whose symmetric boundaries pass the test of closure.
std::optional<double> rest_lumen_volume(const Tissue& tissue) {
  if (!encloses(tissue, tissue.basal_facets)) return std::nullopt;
  return lumen_volume(tissue, tissue.rest_positions);
}

}  // namespace

Observer::Observer(const Model& model, FurrowSites sites, Watch watch)
    : model_(model),
      sites_(std::move(sites)),
      watch_(std::move(watch)),
      rest_{rest_lumen_volume(model.tissue), flank_volume(model.tissue, model.tissue.rest_positions),
            flank_section_area(model.tissue, model.tissue.rest_positions),
            tissue_volume(model, model.tissue.rest_positions)} {
  sites_.contractile.resize(model.tissue.cells.size(), false);  // if there are no sites
}

Observer::Observer(const Model& model, const Observer& other)
    : model_(model), sites_(other.sites_), watch_(other.watch_), rest_(other.rest_), is_left_out_(other.is_left_out_) {}

Observation Observer::row_of(const State& state, const AcceptedStep* step, double wall_s) const {
  Observation row;
  const MeasuredStep measured(model_, sites_, rest_, state, step);
  for (std::size_t c = 0; c < columns().size(); ++c)
    if (columns()[c].of_step && !is_left_out_[c]) row.values[c] = columns()[c].of_step(measured);

  std::vector<Reading> readings;
  for (const Monitor& monitor : watch_.monitors) readings.push_back(read_monitor(monitor, {model_, state, wall_s}));
  for (const Reading& reading : readings) row.monitors.push_back(reading.number);
  row.criteria_met = watch_.stop.met(readings);
  row.is_over = watch_.stop.is_over(row.criteria_met.size(), step != nullptr && step->at_equilibrium);
  return row;
}

void Observer::leave_out(const std::function<bool(const Column&)>& which) {
  for (std::size_t c = 0; c < columns().size(); ++c) is_left_out_[c] = which(columns()[c]);
}

Observation Observer::observe(const AcceptedStep& step, double wall_s) const {
  return row_of(step.state, &step, wall_s);
}

Observation Observer::observe_rest(const State& state) const { return row_of(state, nullptr, 0); }

}  // namespace plica
