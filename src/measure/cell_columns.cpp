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

// The values of all cells by a function of one.
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
      apical_areas(plica::apical_areas(model.tissue, state.positions)),
      rest_apical_areas(plica::rest_apical_areas(model.tissue)) {}

std::vector<double> MeasuredCells::apical_area_ratios() const {
  std::vector<double> ratios(apical_areas.size(), none);
  for (std::size_t c = 0; c < ratios.size(); ++c)
    if (rest_apical_areas[c] > 0) ratios[c] = apical_areas[c] / rest_apical_areas[c];
  return ratios;
}

std::span<const CellColumn> cell_columns() {
  using enum InFrames;
  static const std::vector<CellColumn> table = {
      {"time_s", csv, nothing, "Of the frame.", of_each([](const Cell&, const State& state) { return state.time_s; })},
      {"cell_id", csv, integers,
       "Number of the cell, for life. A daughter has a new one, the mother's is not used again.",
       of_each([](const Cell& cell, const State&) { return cell.lineage.id; })},
      {"mother_id", csv, integers,
       "Number of the cell that it is a daughter of; none (−1 in frames) in the first generation.",
       of_each([](const Cell& cell, const State&) { return cell.lineage.mother >= 0 ? cell.lineage.mother : none; }),
       -1},
      {"generation", csv, integers, "How many divisions lie before it.",
       of_each([](const Cell& cell, const State&) { return cell.lineage.generation; })},
      {"x_um", csv, nothing, "Barycentre: mean of the cell's eight corners.", centre_along(0)},
      {"y_um", csv, nothing, "The same along y.", centre_along(1)},
      {"z_um", csv, nothing, "The same along z.", centre_along(2)},
      {"volume_um3", csv, numbers, "Volume.", [](const C& c) { return c.model.volumes().volumes(c.state.positions); }},
      {"volume_error", no_csv, numbers, "$V/V_{target}-1$.",
       [](const C& c) { return c.model.volumes().relative_errors(c.state.positions); }},
      {"apical_area_um2", csv, nothing, "Area of the bilinear apical facets by 2 × 2 Gauss points.",
       [](const C& c) { return c.apical_areas; }},
      {"basal_area_um2", csv, nothing, "The same of the basal ones.",
       [](const C& c) { return basal_areas(c.model.tissue, c.state.positions); }},
      {"height_um", csv, nothing, "Mean length of the four edges from basal to apical.",
       of_each([](const Cell& cell, const State& state) { return cell_height(cell, state.positions); })},
      {"apical_area_ratio", csv, numbers, "Apical area over that at rest; none (1 in frames) without an apical face.",
       [](const C& c) { return c.apical_area_ratios(); }, 1},
      {"speed_um_per_s", csv, nothing, "Of the barycentre.",
       of_each([](const Cell& cell, const State& state) { return cell_centre(cell, state.velocities).norm(); })},
      {"pressure_Pa", csv, numbers, "What holds the cell's volume; positive in compression.", pressures_Pa},
      {"activity", csv, numbers,
       "Of the cell's program, delay included, in the first contraction by name that it belongs to; 0 outside. Profile "
       "and variation are no part of it.",
       [](const C& c) { return activities(c.model, c.state); }},
      {"strength", no_csv, numbers,
       "Factor that profile and variation put on the cell in the same contraction; 0 outside.",
       [](const C& c) { return strengths(c.model); }},
      {"self_intersecting", csv, integers,
       "1 where an apical or a basal facet of the cell passes through another of the same surface.", crossing}};
  return table;
}

std::span<const NodeColumn> node_columns() {
  static const std::vector<NodeColumn> table = {
      {"displacement_um", "From the node's place at rest.",
       [](const Model& model, const State& state) {
         Vectors displacements = state.positions;
         for (std::size_t n = 0; n < displacements.size(); ++n) displacements[n] -= model.tissue.rest_positions[n];
         return displacements;
       }},
      {"velocity_um_per_s", "At the step's end; with backward Euler the mean over the step.",
       [](const Model&, const State& state) { return state.velocities; }},
      {"force_nN", "The contractions' force on the node, without their dampers.", active_forces}};
  return table;
}

std::span<const MidlineColumn> midline_columns() {
  static const std::vector<MidlineColumn> table = {
      {"time_s", "Of the frame.",
       [](const C& c, const FurrowSites& sites) { return Values(sites.midline.size(), c.state.time_s); }},
      {"ap_um",
       "The cell's x at rest, from anterior to posterior. Where two cells meet on the midline, the right one is there.",
       [](const C& c, const FurrowSites& sites) {
         Values values;
         for (const CellId id : sites.midline)
           values.push_back(cell_centre(c.model.tissue.cells[id.index()], c.model.tissue.rest_positions).x());
         return values;
       }},
      {"depth_um",
       "Mean depth of the cell's points on the cut; as `furrow_depth_um`. Inward is the same direction everywhere, so "
       "near the poles, where the shell runs along it, a little shift counts for much.",
       depths_um},
      {"normal_speed_um_per_s", "Inward speed of its apical corners along the normal at rest.", inward_speeds},
      {"apical_area_ratio", "Apical area over that at rest.", [](const C& c, const FurrowSites& sites) {
         const Values ratios = c.apical_area_ratios();
         Values values;
         for (const CellId id : sites.midline) values.push_back(ratios[id.index()]);
         return values;
       }}};
  return table;
}

std::span<const SectionColumn> section_columns() {
  using S = MeasuredSections;
  // Of each cell, by its place among them.
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
      {"time_s", "Of the frame.", of_cell([](const Cell&, const C& c) { return c.state.time_s; })},
      {"place_percent", "Where the section is at rest: 25, 50 or 75 % of the embryo's length from its anterior end.",
       of_place([](const S& s, std::size_t i) { return s.cells[i].place_percent; })},
      {"from_midline",
       "Number of the cell from the midline at rest: 1, 2, ... to the right, −1, −2, ... to the left; 0 is a cell that "
       "lies on the midline, where a row of cells does. Daughters count, too.",
       of_place([](const S& s, std::size_t i) { return s.cells[i].from_midline; })},
      {"cell_id", "As in `cells.csv`.", of_cell([](const Cell& cell, const C&) { return cell.lineage.id; })},
      {"height_um", "Mean length of the four edges from basal to apical.",
       of_cell([](const Cell& cell, const C& c) { return cell_height(cell, c.state.positions); })},
      {"apical_width_um", "Width of the apex across the embryo's axis, as its long axis is taken.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].width_across_um; })},
      {"volume_um3", "Volume.",
       of_cell([](const Cell& cell, const C& c) { return cell_volume(c.model.tissue, cell, c.state.positions); })},
      {"apical_area_ratio", "Apical area over that at rest.", of_place([](const S& s, std::size_t i) {
         const std::size_t cell = s.cells[i].cell.index();
         return s.measured.apical_areas[cell] / s.measured.rest_apical_areas[cell];
       })},
      {"apical_long_axis_um", "Long side of the rectangle whose area has the second moments of the apex.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].long_axis_um; })},
      {"apical_direction_deg", "Angle of that side to the embryo's axis in the plane of the apex: 0 along, 90 across.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].direction_deg; })},
      {"apical_anisotropy_ratio", "Its long side over its short one.",
       of_place([](const S& s, std::size_t i) { return s.apices[i].long_axis_um / s.apices[i].short_axis_um; })}};
  return table;
}

std::span<const LineageColumn> lineage_columns() {
  static const std::vector<LineageColumn> table = {
      {"cell_id", "Number of the daughter.", [](const Lineage& lineage) { return lineage.id; }},
      {"mother_id", "Number of her mother.", [](const Lineage& lineage) { return lineage.mother; }},
      {"generation", "How many divisions lie before her.", [](const Lineage& lineage) { return lineage.generation; }},
      {"birth_s", "When her mother divided.", [](const Lineage& lineage) { return lineage.birth_s; }}};
  return table;
}

bool is_plicas(std::string_view cell_array) {
  return cell_array.starts_with("region_") || std::ranges::any_of(cell_columns(), [&](const CellColumn& column) {
           return column.in_frames != InFrames::nothing && column.name == cell_array;
         });
}

std::vector<std::string> cells_csv_names() { return names_of(cell_columns(), &CellColumn::in_csv); }

}  // namespace plica
