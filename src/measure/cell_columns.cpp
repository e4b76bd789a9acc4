#include "measure/cell_columns.hpp"

#include <limits>

#include "core/names.hpp"
#include "core/units.hpp"
#include "measure/cells.hpp"
#include "measure/self_intersections.hpp"

namespace plica {
namespace {

using Values = std::vector<double>;
using C = MeasuredCells;

constexpr double none = std::numeric_limits<double>::quiet_NaN();
constexpr bool csv = true, no_csv = false;

// Values of all cells, by a function of one cell.
template <class OfCell>
auto of_each(OfCell of_cell) {
  return [of_cell](const C& c) {
    Values values;
    for (const Cell& cell : c.model.tissue.cells) values.push_back(of_cell(cell, c.state));
    return values;
  };
}

auto centre_along(int axis) {
  return of_each([axis](const Cell& cell, const State& state) { return cell_centre(cell, state.positions)[axis]; });
}

Values pressures_Pa(const C& c) {
  const std::span<const double> pressures = c.state.pressures(c.model);
  Values values(pressures.begin(), pressures.end());
  for (double& value : values) value /= units::pascal;
  return values;
}

Values crossing(const C& c) {
  const CellSet cells = self_intersecting_cells(c.model.tissue, c.state.positions);
  return {cells.begin(), cells.end()};
}

Values depths_um(const C& c, const FurrowSites& sites) {
  Values values;
  for (const auto& depth : cell_depths_um(c.model.tissue, sites, sites.midline, c.state.positions))
    values.push_back(depth.value_or(none));
  return values;
}

Values inward_speeds(const C& c, const FurrowSites& sites) {
  const std::vector<Vec3> normals = rest_apical_normals(c.model.tissue, sites.midline);
  Values values;
  for (std::size_t i = 0; i < sites.midline.size(); ++i)
    values.push_back(-normals[i].dot(mean_apical(c.model.tissue.cells[sites.midline[i].index()], c.state.velocities)));
  return values;
}

}  // namespace

MeasuredCells::MeasuredCells(const Model& of_model, const State& at_state)
    : model(of_model),
      state(at_state),
      apical_areas(face_areas(model.tissue, CellSide::apical, state.positions)),
      rest_apical_areas(rest_face_areas(model.tissue, CellSide::apical)) {}

std::vector<double> MeasuredCells::apical_area_ratios() const {
  std::vector<double> ratios(apical_areas.size(), none);
  for (std::size_t c = 0; c < ratios.size(); ++c)
    if (rest_apical_areas[c] > 0) ratios[c] = apical_areas[c] / rest_apical_areas[c];
  return ratios;
}

std::span<const CellColumn> cell_columns() {
  using enum InFrames;
  static const std::vector<CellColumn> table = {
      {"time_s", csv, nothing, "Time of the snapshot.",
       of_each([](const Cell&, const State& state) { return state.time_s; })},
      {"cell_id", csv, integers, "Permanent number of the cell; daughters get new ones.",
       of_each([](const Cell& cell, const State&) { return cell.lineage.id; })},
      {"mother_id", csv, integers, "Number of the mother cell; none (−1 in snapshots) in the first generation.",
       of_each([](const Cell& cell, const State&) { return cell.lineage.mother >= 0 ? cell.lineage.mother : none; }),
       -1},
      {"generation", csv, integers, "Number of divisions since the first generation.",
       of_each([](const Cell& cell, const State&) { return cell.lineage.generation; })},
      {"x_um", csv, nothing, "Barycentre (mean of eight corners), x.", centre_along(0)},
      {"y_um", csv, nothing, "Barycentre, y.", centre_along(1)},
      {"z_um", csv, nothing, "Barycentre, z.", centre_along(2)},
      {"volume_um3", csv, numbers, "Cell volume.",
       [](const C& c) { return c.model.volumes.volumes(c.state.positions); }},
      {"volume_error", no_csv, numbers, "Relative volume error, $V/V_{target}-1$.",
       [](const C& c) { return c.model.volumes.relative_errors(c.state.positions); }},
      {"apical_area_um2", csv, nothing, "Apical area: bilinear facets, 2 × 2 Gauss points.",
       [](const C& c) { return c.apical_areas; }},
      {"basal_area_um2", csv, nothing, "Basal area.",
       [](const C& c) { return face_areas(c.model.tissue, CellSide::basal, c.state.positions); }},
      {"height_um", csv, nothing, "Cell height: mean length of the apicobasal edges.",
       of_each([](const Cell& cell, const State& state) { return cell_height(cell, state.positions); })},
      {"apical_area_ratio", csv, numbers, "Apical area / reference area; none (1 in snapshots) without an apical face.",
       [](const C& c) { return c.apical_area_ratios(); }, 1},
      {"speed_um_per_s", csv, nothing, "Speed of the barycentre.",
       of_each([](const Cell& cell, const State& state) { return cell_centre(cell, state.velocities).norm(); })},
      {"pressure_Pa", csv, numbers, "Cell pressure (Lagrange multiplier of the volume); positive in compression.",
       pressures_Pa},
      {"activity", csv, numbers,
       "Activity time course with delay, in the first contraction (by name) of the cell; 0 outside. Excludes profile "
       "and "
       "variation.",
       [](const C& c) { return activities(c.model, c.state); }},
      {"strength", no_csv, numbers, "Factor from spatial profile and variation in the same contraction; 0 outside.",
       [](const C& c) { return strengths(c.model); }},
      {"self_intersecting", csv, integers,
       "1 if an apical or basal facet of the cell crosses another of the same surface.", crossing}};
  return table;
}

std::span<const NodeColumn> node_columns() {
  static const std::vector<NodeColumn> table = {
      {"displacement_um", "Displacement from the reference state.",
       [](const Model& model, const State& state) {
         Vectors displacements = state.positions;
         for (std::size_t n = 0; n < displacements.size(); ++n) displacements[n] -= model.tissue.rest_positions[n];
         return displacements;
       }},
      {"velocity_um_per_s", "Velocity at the end of the step (`backward-euler`: mean over the step).",
       [](const Model&, const State& state) { return state.velocities; }},
      {"force_nN", "Force of contractions on the node, without their dampers.", active_forces}};
  return table;
}

std::span<const MidlineColumn> midline_columns() {
  static const std::vector<MidlineColumn> table = {
      {"time_s", "Time of the snapshot.",
       [](const C& c, const FurrowSites& sites) { return Values(sites.midline.size(), c.state.time_s); }},
      {"ap_um", "Reference x of the cell, anterior to posterior; of two cells meeting at the midline, the right one.",
       [](const C& c, const FurrowSites& sites) {
         Values values;
         for (const CellId id : sites.midline)
           values.push_back(cell_centre(c.model.tissue.cells[id.index()], c.model.tissue.rest_positions).x());
         return values;
       }},
      {"depth_um",
       "Mean depth of the cell's apical midline, as `furrow_depth_um`. The inward direction is constant, so near the "
       "poles small shifts change it much.",
       depths_um},
      {"normal_speed_um_per_s", "Inward speed of the apical corners along the reference normal.", inward_speeds},
      {"apical_area_ratio", "Apical area / reference area.", [](const C& c, const FurrowSites& sites) {
         const Values ratios = c.apical_area_ratios();
         Values values;
         for (const CellId id : sites.midline) values.push_back(ratios[id.index()]);
         return values;
       }}};
  return table;
}

std::span<const SectionColumn> section_columns() {
  using S = MeasuredSections;
  // Column of a value per cell, by its index in the section.
  const auto of_place = [](auto value) {
    return [value](const S& s) {
      Values values;
      for (std::size_t i = 0; i < s.cells.size(); ++i) values.push_back(value(s, i));
      return values;
    };
  };
  const auto of_cell = [&](auto value) {
    return of_place([value](const S& s, std::size_t i) {
      return value(s.measured.model.tissue.cells[s.cells[i].cell.index()], s.measured);
    });
  };
  static const std::vector<SectionColumn> table = {
      {"time_s", "Time of the snapshot.", of_cell([](const Cell&, const C& c) { return c.state.time_s; })},
      {"place_percent", "Reference position of the section: 25, 50 or 75 % of the length from the anterior end.",
       of_place([](const S& s, std::size_t i) { return s.cells[i].place_percent; })},
      {"from_midline",
       "Cell number from the midline in the reference state: 1, 2, ... to the right, −1, −2, ... to the left, 0 on it. "
       "Includes daughters.",
       of_place([](const S& s, std::size_t i) { return s.cells[i].from_midline; })},
      {"cell_id", "Number of the cell, as in `cells.csv`.",
       of_cell([](const Cell& cell, const C&) { return cell.lineage.id; })},
      {"height_um", "Cell height: mean length of the apicobasal edges.",
       of_cell([](const Cell& cell, const C& c) { return cell_height(cell, c.state.positions); })},
      {"apical_width_um", "Width of the apical surface across the embryo's axis, from the same rectangle.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].width_across_um; })},
      {"volume_um3", "Cell volume.",
       of_cell([](const Cell& cell, const C& c) { return cell_volume(c.model.tissue, cell, c.state.positions); })},
      {"apical_area_ratio", "Apical area / reference area.", of_place([](const S& s, std::size_t i) {
         const std::size_t cell = s.cells[i].cell.index();
         return s.measured.apical_areas[cell] / s.measured.rest_apical_areas[cell];
       })},
      {"apical_long_axis_um", "Long side of the rectangle with the second moments of the apical surface.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].long_axis_um; })},
      {"apical_direction_deg", "Angle of that side to the embryo's axis: 0 along, 90 across.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].direction_deg; })},
      {"apical_anisotropy_ratio", "Long / short side of that rectangle.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].long_axis_um / s.apices[i].short_axis_um; })}};
  return table;
}

std::span<const LineageColumn> lineage_columns() {
  static const std::vector<LineageColumn> table = {
      {"cell_id", "Number of the daughter.", [](const Lineage& lineage) { return lineage.id; }},
      {"mother_id", "Number of the mother.", [](const Lineage& lineage) { return lineage.mother; }},
      {"generation", "Number of divisions since the first generation.",
       [](const Lineage& lineage) { return lineage.generation; }},
      {"birth_s", "Time of the division of the mother.", [](const Lineage& lineage) { return lineage.birth_s; }}};
  return table;
}

bool is_plicas(std::string_view cell_array) {
  return cell_array.starts_with("region_") || cell_array.starts_with(array_of_signal("")) ||
         std::ranges::any_of(cell_columns(), [&](const CellColumn& column) {
           return column.in_frames != InFrames::nothing && column.name == cell_array;
         });
}

std::vector<std::string> cells_csv_names() { return names_of(cell_columns(), &CellColumn::in_csv); }

}  // namespace plica
