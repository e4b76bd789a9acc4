#include "measure/columns.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/units.hpp"
#include "measure/bending_error.hpp"
#include "measure/cells.hpp"
#include "measure/observation.hpp"
#include "measure/self_intersections.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

constexpr bool series = true, no_series = false;
using enum InSummary;

// Speeds and displacements of the furrow; empty without a furrow, speeds only for steps.
SpeedRow speeds_of(const Tissue& tissue, const FurrowSites& sites, const State& state, bool at_rest) {
  SpeedRow row;
  row.time_s = state.time_s;
  if (sites.vml.empty()) return row;
  row.vml_displacement_um = mean_node_displacement(tissue, sites.vml, state.positions);
  row.vce_displacement_um = mean_node_displacement(tissue, sites.vce, state.positions);
  if (at_rest) return row;
  row.vml_speed_um_per_s = mean_speed(tissue, sites.vml, state.velocities);
  row.vce_speed_um_per_s = mean_speed(tissue, sites.vce, state.velocities);
  return row;
}

std::optional<double> area_ratio(const MeasuredStep& m, const MonitoredCells& cells) {
  if (cells.empty()) return std::nullopt;
  return mean_apical_area_ratio(m.model.tissue, cells, m.state.positions);
}

std::optional<double> lumen_ratio(const MeasuredStep& m) {
  if (!m.rest.lumen_volume_um3) return std::nullopt;
  const auto volume = lumen_volume(m.model.tissue, m.state.positions);
  return volume ? std::optional(*volume / *m.rest.lumen_volume_um3) : std::nullopt;
}

// Column of a number of the solver's report; 0 in the reference state.
Column::OfStep reported(int StepReport::*number) {
  return [=](const MeasuredStep& m) { return m.step != nullptr ? m.step->report.*number : 0; };
}

// Column of an energy summed over all steps so far; 0 in the reference state.
Column::OfStep energy(double EnergyFlow::*number) {
  return [=](const MeasuredStep& m) { return m.step != nullptr ? m.step->energy.*number : 0; };
}

Column count(Column column) {
  column.is_count = true;
  return column;
}

Column costly(Column column) {
  column.is_costly = true;
  return column;
}

Column of_projection(Column column) {
  column.of_projection = true;
  return count(std::move(column));
}

SpeedHistory history_of(std::span<const Observation> rows) {
  std::vector<SpeedRow> speeds;
  speeds.reserve(rows.size());
  for (const Observation& row : rows)
    speeds.push_back({row.time_s(), row["vml_speed_um_per_s"], row["vce_speed_um_per_s"], row["vml_displacement_um"],
                      row["vce_displacement_um"]});
  return speed_history(speeds);
}

Column of_run(std::string_view name, std::string_view meaning, std::optional<double> SpeedHistory::*number) {
  return {name,    no_series, whole_run,
          meaning, {},        [=](std::span<const Observation> rows) {
            return history_of(rows).*number; }};
}

// Time series of a column, without missing values.
struct Course {
  std::vector<double> times_s, values;
};

Course course_of(std::span<const Observation> rows, std::string_view column) {
  Course course;
  for (const Observation& row : rows)
    if (const std::optional<double> value = row[column]) {
      course.times_s.push_back(row.time_s());
      course.values.push_back(*value);
    }
  return course;
}

std::optional<Knee> knee_of(std::span<const Observation> rows) {
  const Course depth = course_of(rows, "furrow_depth_um");
  return knee(depth.times_s, depth.values);
}

// Column of the first time at which another column reaches a level.
Column::OfRun reaching(std::string_view column, double level) {
  return [=](std::span<const Observation> rows) {
    const Course course = course_of(rows, column);
    return time_of_reaching(course.times_s, course.values, level);
  };
}

std::optional<double> first_self_intersection(std::span<const Observation> rows) {
  const auto first = std::ranges::find_if(rows, [](const Observation& row) { return row["self_intersections"] > 0; });
  return first == rows.end() ? std::nullopt : std::optional(first->time_s());
}

template <class Of, class Value>
std::optional<double> part(const std::optional<Of>& of, Value Of::*value) {
  if (!of) return std::nullopt;
  return static_cast<double>((*of).*value);
}

std::optional<double> reduced(InSummary how, std::span<const Observation> rows, std::size_t column) {
  if (how == last) return rows.back().values[column];
  std::optional<double> result;
  for (const Observation& row : rows) {
    const std::optional<double> value = row.values[column];
    if (!value) continue;
    if (!result)
      result = value;
    else if (how == largest)
      result = std::max(*result, *value);
    else if (how == least)
      result = std::min(*result, *value);
    else
      *result += *value;
  }
  return result;
}

}  // namespace

MeasuredStep::MeasuredStep(const Model& of_model, const FurrowSites& at_sites, const RestMeasures& at_rest,
                           const State& at_its_end, const AcceptedStep* accepted)
    : model(of_model),
      sites(at_sites),
      rest(at_rest),
      state(at_its_end),
      step(accepted),
      furrow(furrow_shape(model.tissue, sites, state.positions)),
      speeds(speeds_of(model.tissue, sites, state, step == nullptr)),
      contact_state(plica::contact_state(model, state)),
      enclosed(plica::enclosed(model, state)) {}

std::span<const Column> columns() {
  using M = MeasuredStep;
  static const std::vector<Column> all = {
      {"time_s", series, nothing, "Time at the end of the step; 0 in the reference state.",
       [](const M& m) { return m.state.time_s; }},
      {"furrow_depth_um", series, last,
       "Furrow depth: largest inward distance from the vitelline membrane over the apical midline (plane y = 0) of the "
       "furrow cells, without the middles of polygons, minus the reference value of the same material point. Inward: "
       "against the mean reference apical "
       "normal of these cells. Without an embryo shape (a block): inward displacement.",
       [](const M& m) { return m.furrow.depth_um; }},
      {"furrow_depth_below_lips_um", series, last,
       "Depth of the furrow bottom (apical surface at x = y = 0) below the mean of both lips, positive inward. "
       "Negative "
       "for the convex reference shape; below 1 µm the ventral side is flat, not furrowed.",
       [](const M& m) { return m.furrow.depth_below_lips_um; }},
      {"lip_distance_um", series, last,
       "Distance between the lips, which are material points. For contact, see `lips_closed`.",
       [](const M& m) { return m.furrow.lip_distance_um; }},
      {"highest_points_distance_um", no_series, last,
       "Distance between the outermost points left and right of the midline at x = 0 (the paper's definition); may "
       "jump.",
       [](const M& m) { return m.furrow.highest_points_distance_um; }},
      {"vml_speed_um_per_s", series, nothing,
       "Speed of the barycentre (mean of eight corners) of the central midline cell (VML): at the end of the step "
       "with `bdf2`, mean over the step with `backward-euler`.",
       [](const M& m) { return m.speeds.vml_speed_um_per_s; }},
      {"vce_speed_um_per_s", series, nothing, "Speed of the barycentre of the near-end midline cell (VCE).",
       [](const M& m) { return m.speeds.vce_speed_um_per_s; }},
      {"speed_ratio", series, nothing, "Speed of VCE / speed of VML, $v_c/v_m$.",
       [](const M& m) { return m.speeds.speed_ratio(); }},
      {"vml_displacement_um", series, last,
       "Mean displacement of the eight corner nodes of VML from the reference state (mean of lengths, as in the "
       "paper).",
       [](const M& m) { return m.speeds.vml_displacement_um; }},
      {"vce_displacement_um", series, last, "Mean displacement of the corner nodes of VCE.",
       [](const M& m) { return m.speeds.vce_displacement_um; }},
      {"vml_apical_area_ratio", series, last,
       "Apical area of VML / reference area; bilinear facets, 2 × 2 Gauss points.",
       [](const M& m) { return area_ratio(m, m.sites.vml); }},
      {"vce_apical_area_ratio", series, last, "Apical area of VCE / reference area.",
       [](const M& m) { return area_ratio(m, m.sites.vce); }},
      of_run("peak_speed_ratio",
             "`speed_ratio` at the step with the largest difference $v_c-v_m$, among steps with $v_m$ above 1 % of its "
             "peak. Not the largest `speed_ratio`.",
             &SpeedHistory::peak_ratio),
      of_run("peak_speed_ratio_time_s", "End of that step.", &SpeedHistory::peak_ratio_time_s),
      of_run("ends_lead_until_s",
             "First time after that step with $v_c\\le v_m$, interpolated; null if the ends never lead.",
             &SpeedHistory::ends_lead_until_s),
      of_run("vml_displacement_at_equal_speed_um", "`vml_displacement_um` at that time.",
             &SpeedHistory::vml_displacement_at_equal_speed_um),
      of_run("vce_displacement_at_equal_speed_um", "`vce_displacement_um` at that time.",
             &SpeedHistory::vce_displacement_at_equal_speed_um),
      {"max_node_speed_um_per_s", series, last, "Largest speed of a node; decides equilibrium.",
       [](const M& m) { return m.step != nullptr ? m.step->max_node_speed_um_per_s : 0; }},
      {"max_volume_error", series, largest, "Largest relative volume error of a cell, $\\lvert V/V_{target}-1\\rvert$.",
       [](const M& m) { return max_volume_error(m.model, m.state.positions); }},
      {"max_shell_penetration_um", no_series, largest, "Largest distance of a node outside the vitelline membrane.",
       [](const M& m) { return shell_penetration(m.model, m.state.positions); }},
      costly({"min_scaled_jacobian", no_series, least,
              "Smallest scaled Jacobian of an element corner: 1 for a cuboid, <= 0 if inverted.",
              [](const M& m) { return min_scaled_jacobian(m.model.tissue, m.state.positions); }}),
      costly({"lumen_volume_ratio", series, last,
              "Volume inside the basal surface / reference volume; none for an open surface.", lumen_ratio}),
      count({"cells", series, nothing, "Number of cells, before divisions due at the end of the step.",
             [](const M& m) { return static_cast<double>(m.model.tissue.cells.size()); }}),
      {"step_s", series, nothing, "Length of the time step; 0 in the reference state.",
       [](const M& m) { return m.step != nullptr ? m.step->duration_s : 0; }},
      count({"newton_iterations", series, sum, "Newton iterations, including rejected steps.",
             reported(&StepReport::newton_iterations)}),
      count({"linear_iterations", series, sum,
             "Linear solves (Newton), or conjugate-gradient iterations (linearly implicit).",
             reported(&StepReport::linear_solves)}),
      costly(count({"self_intersections", series, largest,
                    "Pairs of apical or of basal facets that cross (self-intersection). Only `[self_contact]` prevents "
                    "it; results "
                    "after the first are unphysical.",
                    [](const M& m) { return self_intersections(m.model.tissue, m.state.positions); }})),
      of_projection({"projection_sweeps", no_series, sum,
                     "Sweeps of the volume projection (`volume.method = \"projection\"`; "
                     "[paper algorithm](../theory/paper_algorithm.md)).",
                     reported(&StepReport::projection_sweeps)}),
      of_projection(
          {"cubic_solves", no_series, sum, "Cubic equations solved in these sweeps.", reported(&StepReport::cubics)}),
      of_projection({"cubic_three_real_roots", no_series, sum, "Cubic equations with three distinct real roots.",
                     reported(&StepReport::cubics_with_three_roots)}),
      count({"refused_steps", series, sum, "Rejected steps: longer attempts before this step was accepted.",
             reported(&StepReport::refused)}),
      {"vml_height_um", series, largest, "Height of VML: mean length of its apicobasal edges.",
       [](const M& m) -> std::optional<double> {
         if (m.sites.vml.empty()) return std::nullopt;
         double sum = 0;
         for (const CellId cell : m.sites.vml)
           sum += cell_height(m.model.tissue.cells[cell.index()], m.state.positions);
         return sum / static_cast<double>(m.sites.vml.size());
       }},
      costly({"min_apical_area_ratio", series, least, "Smallest apical area / reference area of a cell.",
              [](const M& m) { return min_apical_area_ratio(m.model.tissue, m.state.positions); }}),
      costly({"min_corner_jacobian_ratio", series, least,
              "Smallest corner Jacobian / reference value: 0 for a flat corner.",
              [](const M& m) { return least_corner_ratio(m.model.tissue, m.state.positions).ratio; }}),
      {"enclosed_volume_ratio", series, last, "Enclosed volume (yolk or lumen, `[enclosed.NAME]`) / target volume.",
       [](const M& m) { return part(m.enclosed, &Enclosed::volume_ratio); }},
      {"yolk_pressure_Pa", series, last, "Pressure of the enclosed volume, relative to the perivitelline fluid.",
       [](const M& m) -> std::optional<double> {
         if (!m.enclosed) return std::nullopt;
         return m.enclosed->pressure_kPa / units::pascal;
       }},
      costly(
          {"shell_fluid_um3", series, last,
           "Perivitelline volume, between apical surface and vitelline membrane; its pressure is 0. None for a slice.",
           [](const M& m) -> std::optional<double> {
             if (!m.rest.lumen_volume_um3) return std::nullopt;  // the shell's caps are not the sheet's
             return fluid_under_shell_um3(m.model, m.state.positions);
           }}),
      costly({"flank_volume_ratio", series, last,
              "Volume of the lateral ectoderm / reference volume: cells at 60–120° from the ventral midline, middle "
              "half of "
              "the length, weighted by their part of the angle.",
              [](const M& m) -> std::optional<double> {
                if (m.rest.flank_volume_um3.value_or(0) <= 0) return std::nullopt;
                return *flank_volume(m.model.tissue, m.state.positions) / *m.rest.flank_volume_um3;
              }}),
      count({"contact_pairs", series, largest, "Contact pairs under pressure, with `[self_contact]`.",
             [](const M& m) { return part(m.contact_state, &ContactState::pairs); }}),
      {"min_contact_distance_um", series, least,
       "Smallest gap between facing places of a surface; negative for penetration.",
       [](const M& m) -> std::optional<double> {
         return m.contact_state ? m.contact_state->least_gap_um : std::nullopt;
       }},
      {"closed_length_ratio", series, last,
       "Fraction of the embryo's length with furrow closure: apical surfaces left and right of the midline in contact.",
       [](const M& m) { return part(m.contact_state, &ContactState::closed_length_ratio); }},
      count({"lips_closed", series, last,
             "Furrow closure at x = 0: 1 if apical surfaces of both sides are in contact there, whichever cells meet.",
             [](const M& m) { return part(m.contact_state, &ContactState::middle_is_closed); }}),
      {"lips_closed_time_s",
       no_series,
       whole_run,
       "First time with `lips_closed` = 1.",
       {},
       reaching("lips_closed", 1)},
      {"depth_20um_time_s",
       no_series,
       whole_run,
       "Time at which `furrow_depth_um` reaches 20 µm.",
       {},
       reaching("furrow_depth_um", 20)},
      {"knee_depth_um",
       no_series,
       whole_run,
       "Depth at the onset of fast invagination: breakpoint of a two-segment fit to `furrow_depth_um` over time up to "
       "20 µm (least squares, weighted by time); none if 20 µm are not reached.",
       {},
       [](std::span<const Observation> rows) { return part(knee_of(rows), &Knee::depth_um); }},
      {"knee_time_s",
       no_series,
       whole_run,
       "Time of the onset of fast invagination.",
       {},
       [](std::span<const Observation> rows) { return part(knee_of(rows), &Knee::time_s); }},
      {"active_work_nN_um", series, last,
       "Active work so far: by tensions and contractions, imposed stiffening, applied pressures "
       "([energy](../theory/energy.md)). 1 nN µm = 1 fJ.",
       energy(&EnergyFlow::active)},
      {"stored_energy_nN_um", series, last, "Elastic energy stored since the start.", energy(&EnergyFlow::stored)},
      {"dissipated_energy_nN_um", series, last,
       "Energy dissipated so far: drag, viscosity, relaxation of stress-free shapes, imposed softening, contact "
       "changes.",
       energy(&EnergyFlow::dissipated)},
      {"energy_imbalance_ratio", series, last,
       "(Active work − stored − dissipated) / active work: a defect of finite time steps, of either sign and of the "
       "order "
       "of `time.integrator`, not a bound on their error ([energy](../theory/energy.md)). None without active work.",
       [](const M& m) -> std::optional<double> {
         if (m.step == nullptr || m.step->energy.active <= 0) return std::nullopt;
         const auto& [active, stored, dissipated] = m.step->energy;
         return (active - stored - dissipated) / active;
       }},
      costly({"flank_section_area_ratio", series, last,
              "Cross-sectional area of the lateral ectoderm at x = 0 (60–120° from the ventral midline, both sides) / "
              "reference area; comparable with micrographs and two-dimensional models.",
              [](const M& m) -> std::optional<double> {
                if (m.rest.flank_section_um2.value_or(0) <= 0) return std::nullopt;
                return *flank_section_area(m.model.tissue, m.state.positions) / *m.rest.flank_section_um2;
              }}),
      costly(count({"short_edges", series, largest,
                    "Apical cell edges shorter than 10 % of their reference length; a tissue would exchange neighbours "
                    "(T1) there, "
                    "plica does not.",
                    [](const M& m) { return static_cast<double>(short_edges(m.model.tissue, m.state.positions)); }})),
      {"midline_waviness_um", series, last,
       "Waviness (buckling) of the furrow bottom along its length: root-mean-square deviation of the depths of "
       "contractile midline cells, middle half, from a quartic polynomial. None with fewer than ten cells.",
       [](const M& m) { return midline_waviness_um(m.model.tissue, m.sites, m.state.positions); }},
      {"bending_error", series, last,
       "Estimated relative error of bending from few elements through the height: 0.14 times the difference of a "
       "cell's basal and apical area ratios, divided by its elements, weighted by that difference. Depth by one "
       "element may err five times as much ([convergence](../developers/convergence.md#meshes-of-polygons)). None "
       "without corotational elasticity.",
       [](const M& m) { return bending_error(m.model, m.state.positions); }},
      {"max_displacement_um", series, last, "Largest distance of a node from its reference position.",
       [](const M& m) { return max_displacement(m.model.tissue, m.state.positions); }},
      {"mean_height_um", series, last, "Mean height of all cells.",
       [](const M& m) { return mean_height(m.model.tissue, m.state.positions); }},
      costly({"tissue_volume_ratio", series, last, "Volume of all cells / reference volume.",
              [](const M& m) { return tissue_volume(m.model, m.state.positions) / m.rest.tissue_volume_um3; }}),
      {"self_intersections_time_s",
       no_series,
       whole_run,
       "First time with `self_intersections` > 0.",
       {},
       first_self_intersection},
  };
  return all;
}

std::size_t column_index(std::string_view name) {
  const auto found = std::ranges::find(columns(), name, &Column::name);
  if (found == columns().end()) throw std::logic_error("unknown column " + std::string(name));
  return static_cast<std::size_t>(found - columns().begin());
}

std::vector<std::string> series_names() { return names_of(columns(), &Column::in_series); }

std::vector<const Column*> summary_columns() {
  std::vector<const Column*> found;
  for (const Column& column : columns())
    if (column.in_summary != nothing) found.push_back(&column);
  // summary.json lists areas before displacements; this order predates the table.
  const auto at = [&](std::string_view name) { return std::ranges::find(found, name, &Column::name); };
  std::rotate(at("vml_displacement_um"), at("vml_apical_area_ratio"), at("peak_speed_ratio"));
  return found;
}

std::vector<std::pair<const Column*, std::optional<double>>> summary_values(std::span<const Observation> rows) {
  std::vector<std::pair<const Column*, std::optional<double>>> values;
  for (const Column* column : summary_columns())
    values.emplace_back(
        column, column->of_run ? column->of_run(rows) : reduced(column->in_summary, rows, column_index(column->name)));
  return values;
}

}  // namespace plica
