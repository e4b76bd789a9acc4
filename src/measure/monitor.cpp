#include "measure/monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.hpp"
#include "measure/cells.hpp"
#include "measure/cross_section.hpp"
#include "measure/energy_norm.hpp"
#include "measure/region_shape.hpp"
#include "mechanics/cell_stress.hpp"

namespace plica {

namespace {

/// Reference snapshot with this mesh; empty if there is none.
std::optional<Frame> reference_frame(const Monitor& monitor, const Moment& moment) {
  std::optional<Frame> frame =
      monitor.reference_frame ? monitor.reference_frame : monitor.reference_run->frame_at(moment.state.time_s);
  if (frame && frame->elements != moment.model.tissue.elements) frame.reset();
  return frame;
}

std::vector<double> energy_norm_values(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  const std::optional<Frame> frame = reference_frame(monitor, moment);
  if (!frame) return {};
  const CellSet& region = tissue.regions.at(monitor.region);
  RestMesh mesh{tissue.elements, tissue.element_rest_shape, {}};
  for (const CellId cell : tissue.element_cell) mesh.chosen.push_back(region[cell.index()]);
  Vectors displacements, references;
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    displacements.push_back(moment.state.positions[n] - tissue.rest_positions[n]);
    references.push_back(frame->positions[n] - tissue.rest_positions[n]);
  }
  const auto norm = relative_energy_norm(mesh, monitor.poisson_ratio, displacements, references);
  return norm ? std::vector<double>{*norm} : std::vector<double>{};
}

/// Kinetic energy with an eighth of each element's mass at each of its nodes, as in Inertia; empty without mass.
std::vector<double> kinetic_energy_values(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  const CellSet& region = tissue.regions.at(monitor.region);
  const std::span<const double> masses = moment.model.masses();
  if (masses.empty()) return {};
  double mass = 0, rest_volume = 0, energy_of_unit_density = 0;
  for (const double part : masses) mass += part;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    const double volume = hex_volume(tissue.element_rest_shape[e]);
    rest_volume += volume;
    if (!region[tissue.element_cell[e].index()]) continue;
    for (const NodeId node : tissue.elements[e])
      energy_of_unit_density += 0.5 * volume / 8 * moment.state.velocities[node.index()].squaredNorm();
  }
  return {mass / rest_volume * energy_of_unit_density};
}

/// Component or norm of a vector at each node of the monitor.
template <class VectorAt>
std::vector<double> at_nodes(const Monitor& monitor, const Moment& moment, const VectorAt& vector_at) {
  std::vector<double> values;
  for (const NodeId node : monitored_nodes(monitor, moment.model.tissue)) {
    const Vec3 vector = vector_at(node.index());
    values.push_back(monitor.axis ? vector[*monitor.axis] : vector.norm());
  }
  return values;
}

std::vector<double> positions(const Monitor& monitor, const Moment& moment) {
  return at_nodes(monitor, moment, [&](std::size_t n) { return moment.state.positions[n]; });
}

std::vector<double> displacements(const Monitor& monitor, const Moment& moment) {
  const Vectors& rest = moment.model.tissue.rest_positions;
  return at_nodes(monitor, moment, [&](std::size_t n) -> Vec3 { return moment.state.positions[n] - rest[n]; });
}

std::vector<double> velocities(const Monitor& monitor, const Moment& moment) {
  return at_nodes(monitor, moment, [&](std::size_t n) { return moment.state.velocities[n]; });
}

std::vector<double> deviations(const Monitor& monitor, const Moment& moment) {
  const std::optional<Frame> frame = reference_frame(monitor, moment);
  if (!frame) return {};
  return at_nodes(monitor, moment,
                  [&](std::size_t n) -> Vec3 { return moment.state.positions[n] - frame->positions[n]; });
}

std::vector<double> node_forces(const Monitor& monitor, const Moment& moment) {
  const auto& [model, state, wall_s] = moment;
  if (!monitor.from.empty() && !(monitor.apart && monitor.apart->are_of(model)))
    monitor.apart = std::make_shared<const CellsApart>(model, state.positions, model.tissue.regions.at(monitor.from));
  const Vectors forces = monitor.from.empty() ? driving_forces(model, state) : monitor.apart->forces(model, state);
  return at_nodes(monitor, moment, [&](std::size_t n) { return forces[n]; });
}

std::vector<double> surface_distances(const Monitor& monitor, const Moment& moment) {
  std::vector<double> values;
  for (const NodeId node : monitored_nodes(monitor, moment.model.tissue))
    values.push_back(monitor.reference_surface->from(moment.state.positions[node.index()]));
  return values;
}

std::vector<double> elongations(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  std::vector<double> values;
  for (const FaceShape& apex : apical_shapes(tissue, monitored_cells(monitor, tissue), moment.state.positions)) {
    const double value = apex.length_along_um / apex.width_across_um;
    if (std::isfinite(value)) values.push_back(value);
  }
  return values;
}

// Those of the monitor's cells among values of all cells.
std::vector<double> at_cells(const Monitor& monitor, const Moment& moment, const std::vector<double>& of_all) {
  std::vector<double> values;
  for (const CellId cell : monitored_cells(monitor, moment.model.tissue)) values.push_back(of_all[cell.index()]);
  return values;
}

std::vector<double> apical_loads(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  const Vectors forces = driving_forces(moment.model, moment.state);
  Vectors areas(tissue.node_count(), Vec3::Zero());
  for (const Facet& facet : tissue.apical_facets) {
    const Vec3 area = facet_area_vector(gather(moment.state.positions, facet));
    for (const NodeId node : facet.nodes) areas[node.index()] += area / 4;
  }
  Vectors loads(tissue.node_count(), Vec3::Zero());
  for (std::size_t n = 0; n < loads.size(); ++n)
    if (areas[n] != Vec3::Zero()) loads[n].x() = -forces[n].dot(areas[n]) / areas[n].squaredNorm() / units::pascal;
  std::vector<double> of_cells;
  of_cells.reserve(tissue.cells.size());
  for (const Cell& cell : tissue.cells) of_cells.push_back(mean_apical(cell, loads).x());
  return at_cells(monitor, moment, of_cells);
}

std::vector<double> inward_displacements(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  const std::vector<CellId> cells = monitored_cells(monitor, tissue);
  std::vector<double> values;
  for (const Vec3& normal : rest_apical_normals(tissue, cells)) {
    const Cell& cell = tissue.cells[cells[values.size()].index()];
    values.push_back(normal.dot(mean_apical(cell, tissue.rest_positions) - mean_apical(cell, moment.state.positions)));
  }
  return values;
}

std::vector<double> depths(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  return depths_below_border_um(tissue, tissue.regions.at(monitor.region), monitored_cells(monitor, tissue),
                                moment.state.positions);
}

std::vector<double> curvatures(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  const auto curvature = curvature_per_um(tissue, monitor.face.value_or(CellSide::apical),
                                          tissue.regions.at(monitor.region), monitor.axis, moment.state.positions);
  return curvature ? std::vector<double>{*curvature} : std::vector<double>{};
}

std::vector<double> volumes(const Monitor& monitor, const Moment& moment) {
  return at_cells(monitor, moment, moment.model.volumes.volumes(moment.state.positions));
}

std::vector<double> areas(const Monitor& monitor, const Moment& moment) {
  const CellSide side = monitor.face.value_or(CellSide::apical);
  return at_cells(monitor, moment, face_areas(moment.model.tissue, side, moment.state.positions));
}

std::vector<double> area_ratios(const Monitor& monitor, const Moment& moment) {
  std::vector<double> ratios = face_areas(moment.model.tissue, CellSide::apical, moment.state.positions);
  const std::vector<double> at_rest = rest_face_areas(moment.model.tissue, CellSide::apical);
  for (std::size_t c = 0; c < ratios.size(); ++c) ratios[c] /= at_rest[c];
  return at_cells(monitor, moment, ratios);
}

std::vector<double> pressures(const Monitor& monitor, const Moment& moment) {
  if (!moment.model.volumes.is_held()) return {};
  std::vector<double> in_Pa;
  for (const double pressure : moment.state.pressures(moment.model)) in_Pa.push_back(pressure / units::pascal);
  return at_cells(monitor, moment, in_Pa);
}

std::vector<double> stresses(const Monitor& monitor, const Moment& moment) {
  std::vector<double> in_Pa = passive_stresses(moment.model, moment.state);
  for (double& stress : in_Pa) stress /= units::pascal;
  return at_cells(monitor, moment, in_Pa);
}

std::vector<double> simulated_time(const Monitor&, const Moment& moment) { return {moment.state.time_s}; }

std::vector<double> computing_time(const Monitor&, const Moment& moment) { return {moment.wall_s}; }

using Of = Quantity::Of;
using Reference = Quantity::Reference;
constexpr auto may = Quantity::Axis::may_have, must = Quantity::Axis::must_have, no_axis = Quantity::Axis::none;

constexpr std::array<Quantity, 21> table = {{
    {"position", "um", Of::node, positions, "Coordinate along `axis`.", must},
    {"displacement", "um", Of::node, displacements, "Displacement from the reference state: norm, or component.", may},
    {"speed", "um_per_s", Of::node, velocities,
     "Norm of the velocity at the end of the step (`backward-euler`: mean over the step)."},
    {"velocity", "um_per_s", Of::node, velocities, "Component of the velocity along `axis`.", must},
    {"deviation", "um", Of::node, deviations,
     "Displacement from the same node of the run `reference`: norm, or component.", may, Reference::run},
    {"relative_energy_norm", "", Of::region, energy_norm_values,
     "$\\sqrt{(u-u_r)^TK(u-u_r)}\\,/\\sqrt{u_r^TKu_r}$ of displacements $u$, $u_r$ those of `reference`; $K$: linear "
     "stiffness of the region's undeformed elements. Includes rigid rotation. No value for an undeformed reference.",
     no_axis, Reference::run},
    {"surface_distance", "um", Of::node, surface_distances,
     "Distance to the surface in the mesh file `reference` (VTK, STL, PLY, OBJ; boundary of a volume mesh); >= 0.",
     no_axis, Reference::surface},
    {"force", "nN", Of::node, node_forces,
     "Static force of elasticity, contractions and applied pressures on the node, without cell pressures and shell "
     "contact, which balance it at equilibrium. With `from = \"REGION\"`: force of the cells of this region, including "
     "their cell pressures.",
     may},
    {"volume", "um3", Of::cell, volumes, "Cell volume; negative if inverted."},
    {"area", "um2", Of::side, areas, "Apical area, or basal with `face = \"basal\"`."},
    {"area_ratio", "", Of::side, area_ratios,
     "Apical area / reference area; means are over cells, not weighted by area."},
    {"apical_elongation", "", Of::side, elongations,
     "Length of the apical surface along x / width across, of the rectangle with its second moments. None at a pole."},
    {"pressure", "Pa", Of::cell, pressures, "Cell pressure; positive in compression."},
    {"stress", "Pa", Of::cell, stresses,
     "Passive tension in the plane of the sheet, as `stress_Pa` of `[cortex.NAME]`."},
    {"apical_load", "Pa", Of::side, apical_loads,
     "Inward component of the driving force (as `force`) per apical area around a node, mean over the cell's apical "
     "corners."},
    {"inward_displacement", "um", Of::side, inward_displacements,
     "Displacement of the mean apical corner against the outward reference normal."},
    {"depth", "um", Of::side, depths,
     "Depth of the mean apical corner below those of the cells around the region (nearest ones, by 1/distance⁴), along "
     "the reference normal; 0 in the reference state."},
    {"curvature", "per_um", Of::region, curvatures,
     "Curvature of the region's apical surface, or basal with `face`, in its middle, of the quadric nearest to its "
     "nodes; positive if it bulges outward. Mean curvature, or that along `axis`, projected into the surface.",
     may},
    {"kinetic_energy", "nN_um", Of::region, kinetic_energy_values,
     "$\\tfrac12\\sum m v^2$ with lumped masses; requires a density."},
    {"time", "s", Of::region, simulated_time, "Simulated time; for stop criteria."},
    {"wall", "s", Of::region, computing_time,
     "Computing time of all steps so far; the only quantity that differs between repeated runs."},
}};

}  // namespace

std::span<const Quantity> quantities() { return table; }

const Quantity* quantity_named(std::string_view name) {
  const auto found = std::ranges::find(table, name, &Quantity::name);
  return found == table.end() ? nullptr : &*found;
}

std::string Monitor::column() const {
  return fmt::format("{}.{}{}{}", name, quantity->name, quantity->unit.empty() ? "" : "_", quantity->unit);
}

std::vector<NodeId> monitored_nodes(const Monitor& monitor, const Tissue& tissue) {
  const CellSet& region = tissue.regions.at(monitor.region);
  std::vector<bool> monitored(tissue.node_count(), false);
  if (!monitor.face) {
    for (std::size_t e = 0; e < tissue.elements.size(); ++e)
      if (region[tissue.element_cell[e].index()])
        for (const NodeId node : tissue.elements[e]) monitored[node.index()] = true;
  } else {
    for (const Facet& facet : tissue.facets(*monitor.face))
      if (region[facet.cell.index()])
        for (const NodeId node : facet.nodes) monitored[node.index()] = true;
  }
  std::vector<NodeId> nodes;
  for (std::size_t n = 0; n < monitored.size(); ++n)
    if (monitored[n]) nodes.emplace_back(n);
  return nodes;
}

std::vector<CellId> monitored_cells(const Monitor& monitor, const Tissue& tissue) {
  CellSet chosen = tissue.regions.at(monitor.region);
  if (monitor.quantity->of == Of::side) {
    CellSet has_side(chosen.size(), false);
    for (const Facet& facet : tissue.facets(monitor.face.value_or(CellSide::apical)))
      has_side[facet.cell.index()] = chosen[facet.cell.index()];
    chosen = std::move(has_side);
  }
  std::vector<CellId> cells;
  for (std::size_t c = 0; c < chosen.size(); ++c)
    if (chosen[c]) cells.emplace_back(c);
  return cells;
}

std::optional<double> combined(Over over, std::span<const double> values) {
  if (values.empty()) return std::nullopt;
  if (over == Over::max) return *std::ranges::max_element(values);
  if (over == Over::min) return *std::ranges::min_element(values);
  double sum = 0;
  for (const double value : values) sum += over == Over::rms ? value * value : value;
  if (over == Over::sum) return sum;
  const double mean = sum / static_cast<double>(values.size());
  return over == Over::rms ? std::sqrt(mean) : mean;
}

Reading read_monitor(const Monitor& monitor, const Moment& moment) {
  const std::vector<double> values = monitor.quantity->values(monitor, moment);
  return {values, combined(monitor.over, values)};
}

}  // namespace plica
