// Sets of every tissue: what each run measures, and the volume projection.
#include <algorithm>

#include "measure/cells.hpp"
#include "measure/measure_set.hpp"
#include "measure/observation.hpp"
#include "measure/self_intersections.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

using enum InSummary;
using M = ColumnInput;

// Column of a number of the solver's report; 0 in the reference state.
Column::OfStep reported(int StepReport::*number) {
  return [=](const M& m) { return m.step != nullptr ? m.step->report.*number : 0; };
}

// Column of an energy summed over all steps so far; 0 in the reference state.
Column::OfStep energy(double EnergyFlow::*number) {
  return [=](const M& m) { return m.step != nullptr ? m.step->energy.*number : 0; };
}

std::optional<double> energy_imbalance(const M& m) {
  if (m.step == nullptr || m.step->energy.active <= 0) return std::nullopt;
  const auto& [active, stored, dissipated] = m.step->energy;
  return (active - stored - dissipated) / active;
}

std::optional<double> first_self_intersection(std::span<const Observation> rows) {
  const auto first = std::ranges::find_if(rows, [](const Observation& row) { return row["self_intersections"] > 0; });
  return first == rows.end() ? std::nullopt : std::optional(first->time_s());
}

std::vector<Column> columns_of_every_run() {
  return {
      {"time_s", nothing, "Time at the end of the step; 0 in the reference state.",
       [](const M& m) { return m.state.time_s; }},
      {"max_node_speed_um_per_s", last, "Largest speed of a node; decides equilibrium.",
       [](const M& m) { return m.step != nullptr ? m.step->max_node_speed_um_per_s : 0; }},
      {"max_volume_error", largest, "Largest relative volume error of a cell, $\\lvert V/V_{target}-1\\rvert$.",
       of(max_volume_error)},
      costly({"min_scaled_jacobian", least,
              "Smallest scaled Jacobian of an element corner: 1 for a cuboid, <= 0 if inverted.",
              [](const M& m) { return min_scaled_jacobian(m.model.tissue, m.state.positions); }}),
      count({"cells", nothing, "Number of cells, before divisions due at the end of the step.",
             [](const M& m) { return static_cast<double>(m.model.tissue.cells.size()); }}),
      {"step_s", nothing, "Length of the time step; 0 in the reference state.",
       [](const M& m) { return m.step != nullptr ? m.step->duration_s : 0; }},
      count({"newton_iterations", sum, "Newton iterations, including rejected steps.",
             reported(&StepReport::newton_iterations)}),
      count({"linear_iterations", sum, "Linear solves (Newton), or conjugate-gradient iterations (linearly implicit).",
             reported(&StepReport::linear_solves)}),
      costly(count({"self_intersections", largest,
                    "Pairs of apical or of basal facets that cross (self-intersection). Only `[self_contact]` prevents "
                    "it; results after the first are unphysical.",
                    of(self_intersections)})),
      count({"refused_steps", sum, "Rejected steps: longer attempts before this step was accepted.",
             reported(&StepReport::refused)}),
      costly({"min_apical_area_ratio", least, "Smallest apical area / reference area of a cell.",
              of(min_apical_area_ratio)}),
      costly({"min_corner_jacobian_ratio", least, "Smallest corner Jacobian / reference value: 0 for a flat corner.",
              [](const M& m) { return least_corner_ratio(m.model.tissue, m.state.positions).ratio; }}),
      {"active_work_nN_um", last,
       "Active work so far: by tensions and contractions, imposed stiffening, applied pressures "
       "([energy](../theory/energy.md)). 1 nN µm = 1 fJ.",
       energy(&EnergyFlow::active)},
      {"stored_energy_nN_um", last, "Elastic energy stored since the start.", energy(&EnergyFlow::stored)},
      {"dissipated_energy_nN_um", last,
       "Energy dissipated so far: drag, viscosity, relaxation of stress-free shapes, imposed softening, contact "
       "changes.",
       energy(&EnergyFlow::dissipated)},
      {"energy_imbalance_ratio", last,
       "(Active work − stored − dissipated) / active work: a defect of finite time steps, of either sign, not a bound "
       "on their error ([energy](../theory/energy.md)). None without active work.",
       energy_imbalance},
      costly(count({"short_edges", largest,
                    "Apical cell edges shorter than 10 % of their reference length; cells exchange neighbours there "
                    "only with `[exchange]`.",
                    of(short_edges)})),
      {"max_displacement_um", last, "Largest distance of a node from its reference position.", of(max_displacement)},
      {"mean_height_um", last, "Mean height of all cells.", of(mean_height)},
      costly({"tissue_volume_ratio", last, "Volume of all cells / reference volume.",
              [](const M& m) { return tissue_volume(m.model, m.state.positions) / m.of_set<double>(); }}),
      {"self_intersections_time_s",
       whole_run,
       "First time with `self_intersections` > 0.",
       {},
       first_self_intersection},
  };
}

}  // namespace

MeasureSet run_set() {
  return set_of(
      "", "", [](const Subject& s) { return std::any(tissue_volume(s.model, s.model.tissue.rest_positions)); },
      columns_of_every_run());
}

MeasureSet projection_set() {
  return set_of("projection", "volume.method = \"projection\"", [](const Subject& s) { return kept_if(s.projects); },
                {count({"projection_sweeps", sum,
                        "Sweeps of the projection ([paper algorithm](../developers/paper-algorithm.md)).",
                        reported(&StepReport::projection_sweeps)}),
                 count({"cubic_solves", sum, "Cubic equations solved in these sweeps.", reported(&StepReport::cubics)}),
                 count({"cubic_three_real_roots", sum, "Cubic equations with three distinct real roots.",
                        reported(&StepReport::cubics_with_three_roots)})});
}

}  // namespace plica
