#include "measure/columns.hpp"

#include <algorithm>
#include <stdexcept>

#include "core/units.hpp"
#include "measure/cells.hpp"
#include "measure/observation.hpp"
#include "measure/self_intersections.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

constexpr bool series = true, no_series = false;
using enum InSummary;

// Of the speeds and displacements: none where no furrow is measured, and speeds only of a step.
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

// A number of the solver's report; 0 at rest.
Column::OfStep reported(int StepReport::*number) {
  return [=](const MeasuredStep& m) { return m.step != nullptr ? m.step->report.*number : 0; };
}

// Of all steps so far; 0 at rest.
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

// A column's values over time, where it has any.
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

// When a column reaches a level for the first time.
Column::OfRun reaching(std::string_view column, double level) {
  return [=](std::span<const Observation> rows) {
    const Course course = course_of(rows, column);
    return time_of_reaching(course.times_s, course.values, level);
  };
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
      touching(plica::touching(model, state)),
      enclosed(plica::enclosed(model, state)) {}

std::span<const Column> columns() {
  using M = MeasuredStep;
  static const std::vector<Column> all = {
      {"time_s", series, nothing, "End of the step; 0 at rest.", [](const M& m) { return m.state.time_s; }},
      {"furrow_depth_um", series, last,
       "The apical surface of the furrow's cells cut by the plane y = 0; of all points on the cut, the largest "
       "distance inside the shell, less the same of the same material point at rest (flat facets lie a little inside "
       "a round shell; negative where it has gone out). Inward is against the mean apical normal of these cells at "
       "rest: up for a belly, down for a sheet whose apices are on top. Without a shell's shape (a block): how far the "
       "point has gone in.",
       [](const M& m) { return m.furrow.depth_um; }},
      {"furrow_depth_below_lips_um", series, last,
       "In the mid cross-section (x = 0): height of the floor (the cut at y = 0) over the mean height of the two lips, "
       "positive when the floor lies inside. Under 1 µm the belly is flattened and not furrowed; at rest it is "
       "negative, the belly being convex.",
       [](const M& m) { return m.furrow.depth_below_lips_um; }},
      {"lip_distance_um", series, last,
       "Between the lips: the two points where the mid cross-section left the contractile cells at rest. Material "
       "points, fixed for the run: borders of a region, not where a furrow closes (`lips_closed`).",
       [](const M& m) { return m.furrow.lip_distance_um; }},
      {"highest_points_distance_um", no_series, last,
       "The paper's pair beside it: between the outermost points of the mid cross-section left and right of the "
       "midline. They may jump.",
       [](const M& m) { return m.furrow.highest_points_distance_um; }},
      {"vml_speed_um_per_s", series, nothing,
       "Speed of the VML's barycentre (the mean of its eight corners, as in the paper, 3.1), not of its nodes: at the "
       "step's end with bdf2, the mean over the step with backward Euler. None at rest.",
       [](const M& m) { return m.speeds.vml_speed_um_per_s; }},
      {"vce_speed_um_per_s", series, nothing, "The same of the VCE.",
       [](const M& m) { return m.speeds.vce_speed_um_per_s; }},
      {"speed_ratio", series, nothing, "$v_c/v_m$: the speed of the VCE over that of the VML.",
       [](const M& m) { return m.speeds.speed_ratio(); }},
      {"vml_displacement_um", series, last,
       "Mean length of the displacements of the VML's eight corner nodes from rest, not that of its barycentre: the "
       "paper gives displacements of *nodes* (section 4, Figs. 9 and 10).",
       [](const M& m) { return m.speeds.vml_displacement_um; }},
      {"vce_displacement_um", series, last, "The same of the VCE.",
       [](const M& m) { return m.speeds.vce_displacement_um; }},
      {"vml_apical_area_ratio", series, last,
       "Apical area of the VML over that at rest; area of the bilinear facet by 2 × 2 Gauss points.",
       [](const M& m) { return area_ratio(m, m.sites.vml); }},
      {"vce_apical_area_ratio", series, last, "The same of the VCE.",
       [](const M& m) { return area_ratio(m, m.sites.vce); }},
      of_run(
          "peak_speed_ratio",
          "`speed_ratio` of the step for which $v_c-v_m$ (VCE's speed less VML's) is largest, among steps with $v_m$ "
          "over 1 % of its peak. Not the largest `speed_ratio`.",
          &SpeedHistory::peak_ratio),
      of_run("peak_speed_ratio_time_s", "End of that step.", &SpeedHistory::peak_ratio_time_s),
      of_run("ends_lead_until_s",
             "First time after that when $v_c\\le v_m$, linear between steps; null where the ends never lead.",
             &SpeedHistory::ends_lead_until_s),
      of_run("vml_displacement_at_equal_speed_um", "`vml_displacement_um` at that time.",
             &SpeedHistory::vml_displacement_at_equal_speed_um),
      of_run("vce_displacement_at_equal_speed_um", "The same of the VCE.",
             &SpeedHistory::vce_displacement_at_equal_speed_um),
      {"max_node_speed_um_per_s", series, last,
       "Speed of the fastest node of the body, taken as that of the VML; 0 at rest. Equilibrium goes by it.",
       [](const M& m) { return m.step != nullptr ? m.step->max_node_speed_um_per_s : 0; }},
      {"max_volume_error", series, largest, "Largest $\\lvert V/V_{target}-1\\rvert$ over cells.",
       [](const M& m) { return max_volume_error(m.model, m.state.positions); }},
      {"max_shell_penetration_um", no_series, largest, "Deepest place of any apical node outside the shell.",
       [](const M& m) { return shell_penetration(m.model, m.state.positions); }},
      costly({"min_scaled_jacobian", no_series, least, "Worst corner of an element: 1 is a brick, 0 is flat.",
              [](const M& m) { return min_scaled_jacobian(m.model.tissue, m.state.positions); }}),
      costly({"lumen_volume_ratio", series, last,
              "Volume inside the basal surface over that at rest; none where that surface is not closed.",
              lumen_ratio}),
      count({"cells", series, nothing, "Number of cells, before those divide that are due at the step's end.",
             [](const M& m) { return static_cast<double>(m.model.tissue.cells.size()); }}),
      {"step_s", series, nothing, "Length of the step; 0 at rest.",
       [](const M& m) { return m.step != nullptr ? m.step->duration_s : 0; }},
      count({"newton_iterations", series, sum,
             "Iterations of Newton's method, those of attempts that were rejected included.",
             reported(&StepReport::newton_iterations)}),
      count({"linear_iterations", series, sum,
             "Newton: solves with a factor. Linearly implicit: iterations of conjugate gradients.",
             reported(&StepReport::linear_solves)}),
      costly(count(
          {"self_intersections", series, largest,
           "Pairs of facets of the apical surface, or of the basal one, that pass through each other. Nothing stops "
           "that: what comes after the first is no tissue any more.",
           [](const M& m) { return self_intersections(m.model.tissue, m.state.positions); }})),
      of_projection({"projection_sweeps", no_series, sum,
                     "With `volume.method = \"projection\"` only: sweeps over the volumes "
                     "([theory/paper_algorithm.md](theory/paper_algorithm.md)).",
                     reported(&StepReport::projection_sweeps)}),
      of_projection({"cubic_solves", no_series, sum, "Cubics solved in them.", reported(&StepReport::cubics)}),
      of_projection({"cubic_three_real_roots", no_series, sum, "How many of those had three different real roots.",
                     reported(&StepReport::cubics_with_three_roots)}),
      count({"refused_steps", series, sum, "Steps that were tried before this one was accepted, and were too long.",
             reported(&StepReport::refused)}),
      {"vml_height_um", series, largest, "Mean height of the VML's cells.",
       [](const M& m) -> std::optional<double> {
         if (m.sites.vml.empty()) return std::nullopt;
         double sum = 0;
         for (const CellId cell : m.sites.vml)
           sum += cell_height(m.model.tissue.cells[cell.index()], m.state.positions);
         return sum / static_cast<double>(m.sites.vml.size());
       }},
      costly({"min_apical_area_ratio", series, least, "The smallest of all cells' apical areas over those at rest.",
              [](const M& m) { return min_apical_area_ratio(m.model.tissue, m.state.positions); }}),
      costly({"min_corner_jacobian_ratio", series, least,
              "Smallest Jacobian of an element's corner over that at rest: 0 is a corner that is flat.",
              [](const M& m) { return min_corner_jacobian_ratio(m.model.tissue, m.state.positions); }}),
      {"enclosed_volume_ratio", series, last,
       "Of a volume that `[enclosed.NAME]` keeps, the yolk's: over what it is kept at.",
       [](const M& m) { return part(m.enclosed, &Enclosed::volume_ratio); }},
      {"yolk_pressure_Pa", series, last, "The pressure in it, over that of the fluid under the shell.",
       [](const M& m) -> std::optional<double> {
         if (!m.enclosed) return std::nullopt;
         return m.enclosed->pressure_kPa / units::pascal;
       }},
      costly({"shell_fluid_um3", series, last,
              "Volume between the apical surface and the shell; the fluid has no pressure. None of a slice.",
              [](const M& m) -> std::optional<double> {
                if (!m.rest.lumen_volume_um3) return std::nullopt;  // the shell's caps are not the sheet's
                return fluid_under_shell_um3(m.model, m.state.positions);
              }}),
      costly({"flank_volume_ratio", series, last,
              "Volume of the cells at 60° to 120° from the belly, on the middle half of the length, over that at rest; "
              "a cell "
              "counts by the part of its angle that lies there. What the furrow takes from the lateral ectoderm.",
              [](const M& m) -> std::optional<double> {
                if (m.rest.flank_volume_um3.value_or(0) <= 0) return std::nullopt;
                return *flank_volume(m.model.tissue, m.state.positions) / *m.rest.flank_volume_um3;
              }}),
      count({"contact_pairs", series, largest,
             "With `[self_contact]`: places of a surface that press on another place of it.",
             [](const M& m) { return part(m.touching, &Touching::pairs); }}),
      {"min_contact_distance_um", series, least,
       "The nearest that two places of a surface come that look at each other; below 0 one is beyond the other.",
       [](const M& m) -> std::optional<double> { return m.touching ? m.touching->least_gap_um : std::nullopt; }},
      {"closed_length_ratio", series, last,
       "Part of the embryo's length along which the apical surfaces of both sides of the midline press on each other.",
       [](const M& m) { return part(m.touching, &Touching::closed_length_ratio); }},
      count({"lips_closed", series, last,
             "1 where they do so in the mid cross-section (x = 0), whichever cells meet; the points of "
             "`lip_distance_um` may be far apart then.",
             [](const M& m) { return part(m.touching, &Touching::middle_is_closed); }}),
      {"lips_closed_time_s", no_series, whole_run, "When they did first.", {}, reaching("lips_closed", 1)},
      {"depth_20um_time_s",
       no_series,
       whole_run,
       "When `furrow_depth_um` passed 20 µm.",
       {},
       reaching("furrow_depth_um", 20)},
      {"knee_depth_um",
       no_series,
       whole_run,
       "Depth at which slow turns into fast: at the break of the line of two straight pieces that is nearest to "
       "`furrow_depth_um` over time (least squares, each row by the time it stands for), up to 20 µm; none for a "
       "furrow that does not get so deep.",
       {},
       [](std::span<const Observation> rows) { return part(knee_of(rows), &Knee::depth_um); }},
      {"knee_time_s",
       no_series,
       whole_run,
       "When that is.",
       {},
       [](std::span<const Observation> rows) { return part(knee_of(rows), &Knee::time_s); }},
      {"active_work_nN_um", series, last,
       "What cells have put in so far: work of their tensions and contractions, of programs that stiffen something, of "
       "applied pressures ([theory/energy.md](theory/energy.md)). 1 nN µm is 1 fJ.",
       energy(&EnergyFlow::active)},
      {"stored_energy_nN_um", series, last,
       "What the tissue has stored of it so far: elastic energies less those at the beginning.",
       energy(&EnergyFlow::stored)},
      {"dissipated_energy_nN_um", series, last,
       "What has been lost so far: to drag and viscosity, to rest areas that flow, to programs that let go of "
       "something, to contacts that change.",
       energy(&EnergyFlow::dissipated)},
      {"energy_imbalance_ratio", series, last,
       "What is missing of the active work so far: the work, less what is stored and dissipated, over the work. The "
       "error of finite steps, of first or second order as `time.integrator` is; large in the first steps, when hardly "
       "any work has been done. None without active work.",
       [](const M& m) -> std::optional<double> {
         if (m.step == nullptr || m.step->energy.active <= 0) return std::nullopt;
         const auto& [active, stored, dissipated] = m.step->energy;
         return (active - stored - dissipated) / active;
       }},
      costly({"flank_section_area_ratio", series, last,
              "Area of the tissue cut at x = 0, between its basal and its apical surface, at 60° to 120° from the "
              "belly on "
              "both sides, over that at rest: what a cross-section under the microscope, or a model in two dimensions, "
              "shows "
              "of the lateral ectoderm. `flank_volume_ratio` is the same of a volume.",
              [](const M& m) -> std::optional<double> {
                if (m.rest.flank_section_um2.value_or(0) <= 0) return std::nullopt;
                return *flank_section_area(m.model.tissue, m.state.positions) / *m.rest.flank_section_um2;
              }}),
      costly(count(
          {"short_edges", series, largest,
           "Apical edges of cells that are shorter than a tenth of their length at rest: cells of a tissue would "
           "change neighbours there, which plica's do not. Of an edge of 7 µm that is 0.7 µm, where a microscope no "
           "longer tells two vertices from one.",
           [](const M& m) { return static_cast<double>(short_edges(m.model.tissue, m.state.positions)); }})),
      {"midline_waviness_um", series, last,
       "How much the furrow's floor goes up and down along its length, as it does where the sheet buckles: of the "
       "midline's contractile cells on the middle half of their length, how far their depths are from a polynomial of "
       "the fourth degree (root mean square). None where fewer than ten cells lie there.",
       [](const M& m) { return midline_waviness_um(m.model.tissue, m.sites, m.state.positions); }},
  };
  return all;
}

std::size_t column_index(std::string_view name) {
  const auto found = std::ranges::find(columns(), name, &Column::name);
  if (found == columns().end()) throw std::logic_error("there is no column " + std::string(name));
  return static_cast<std::size_t>(found - columns().begin());
}

std::vector<std::string> series_names() { return names_of(columns(), &Column::in_series); }

std::vector<const Column*> summary_columns() {
  std::vector<const Column*> found;
  for (const Column& column : columns())
    if (column.in_summary != nothing) found.push_back(&column);
  // There, areas stand before displacements: a contract that is older than this table.
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
