#include "measure/monitor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/units.hpp"
#include "measure/cells.hpp"
#include "measure/cross_section.hpp"
#include "measure/energy_norm.hpp"
#include "mechanics/energy.hpp"
#include "tissue/mirror.hpp"

namespace plica {
namespace {

using Info = QuantityInfo;
constexpr auto may = Info::Axis::may_have, must = Info::Axis::must_have, no_axis = Info::Axis::none;

constexpr std::array<Info, 18> table = {{
    {Quantity::position, "position", "um", Info::Of::node, "Coordinate along `axis`.", must},
    {Quantity::displacement, "displacement", "um", Info::Of::node,
     "Displacement from the reference state: norm, or component.", may},
    {Quantity::speed, "speed", "um_per_s", Info::Of::node,
     "Norm of the velocity at the end of the step (`backward-euler`: mean over the step)."},
    {Quantity::velocity, "velocity", "um_per_s", Info::Of::node, "Component of the velocity along `axis`.", must},
    {Quantity::deviation, "deviation", "um", Info::Of::node,
     "Displacement from the same node of the run `reference`: norm, or component.", may, Info::Reference::run},
    {Quantity::relative_energy_norm, "relative_energy_norm", "", Info::Of::region,
     "$\\sqrt{(u-u_r)^TK(u-u_r)}\\,/\\sqrt{u_r^TKu_r}$ of displacements $u$, $u_r$ those of `reference`; $K$: linear "
     "stiffness of the region's undeformed elements. Includes rigid rotation. No value for an undeformed reference.",
     no_axis, Info::Reference::run},
    {Quantity::surface_distance, "surface_distance", "um", Info::Of::node,
     "Distance to the surface in the mesh file `reference` (VTK, STL, PLY, OBJ; boundary of a volume mesh); >= 0.",
     no_axis, Info::Reference::surface},
    {Quantity::force, "force", "nN", Info::Of::node,
     "Static force of elasticity, contractions and applied pressures on the node, without cell pressures and shell "
     "contact, which balance it at equilibrium. With `from = \"REGION\"`: force of the cells of this region, including "
     "their cell pressures.",
     may},
    {Quantity::volume, "volume", "um3", Info::Of::cell, "Cell volume; negative if inverted."},
    {Quantity::area, "area", "um2", Info::Of::cell, "Apical area, or basal with `face = \"basal\"`."},
    {Quantity::area_ratio, "area_ratio", "", Info::Of::cell,
     "Apical area / reference area; means are over cells, not weighted by area."},
    {Quantity::apical_elongation, "apical_elongation", "", Info::Of::cell,
     "Length of the apical surface along x / width across, of the rectangle with its second moments. None at a pole."},
    {Quantity::pressure, "pressure", "Pa", Info::Of::cell, "Cell pressure; positive in compression."},
    {Quantity::apical_load, "apical_load", "Pa", Info::Of::cell,
     "Inward component of the driving force (as `force`) per apical area around a node, mean over the cell's apical "
     "corners."},
    {Quantity::inward_displacement, "inward_displacement", "um", Info::Of::cell,
     "Displacement of the mean apical corner against the outward reference normal."},
    {Quantity::kinetic_energy, "kinetic_energy", "nN_um", Info::Of::region,
     "$\\tfrac12\\sum m v^2$ with lumped masses; requires a density."},
    {Quantity::time, "time", "s", Info::Of::region, "Simulated time; for stop criteria."},
    {Quantity::wall, "wall", "s", Info::Of::region,
     "Computing time of all steps so far; the only quantity that differs between repeated runs."},
}};

}  // namespace

Vectors forces_of_cells(const Model& model, const State& state, const CellSet& cells) {
  Tissue part = model.tissue;
  const TissueChange kept = keep_only(part, cells);
  const Vectors no_velocity(state.positions.size(), Vec3::Zero());
  const Step now = motionless(state, no_velocity);
  Vectors forces(state.positions.size(), Vec3::Zero());
  for (std::size_t l = 0; l < model.laws.size(); ++l) {
    const std::vector<double> internal = model.laws[l]->internal_after_division(state.internals[l], part, kept, {});
    Step law_step = now;
    law_step.internal = internal;
    model.laws[l]->after_division(part, kept, state.positions)->add_forces(law_step, forces);
  }
  const std::span<const double> pressures = state.pressures(model);
  CellVolumes(part).add_forces(state.positions,
                               inherited(kept, std::vector<double>(pressures.begin(), pressures.end())), forces);
  part.carry_hanging(forces);
  return forces;
}

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

std::vector<double> node_values(const Monitor& monitor, const Moment& moment) {
  const Tissue& tissue = moment.model.tissue;
  const State& state = moment.state;
  const std::vector<NodeId> nodes = monitored_nodes(monitor, tissue);
  const auto collect = [&](const auto& vector_at) {  // component or norm at each node
    std::vector<double> values;
    for (const NodeId node : nodes) {
      const Vec3 vector = vector_at(node.index());
      values.push_back(monitor.axis ? vector[*monitor.axis] : vector.norm());
    }
    return values;
  };
  switch (monitor.quantity) {
    case Quantity::position:
      return collect([&](std::size_t n) { return state.positions[n]; });
    case Quantity::displacement:
      return collect([&](std::size_t n) -> Vec3 { return state.positions[n] - tissue.rest_positions[n]; });
    case Quantity::speed:
    case Quantity::velocity:
      return collect([&](std::size_t n) { return state.velocities[n]; });
    case Quantity::deviation: {
      const std::optional<Frame> frame = reference_frame(monitor, moment);
      if (!frame) return {};
      return collect([&](std::size_t n) -> Vec3 { return state.positions[n] - frame->positions[n]; });
    }
    case Quantity::force: {
      const Vectors forces = monitor.from.empty()
                                 ? driving_forces(moment.model, state)
                                 : forces_of_cells(moment.model, state, tissue.regions.at(monitor.from));
      return collect([&](std::size_t n) { return forces[n]; });
    }
    case Quantity::surface_distance: {
      std::vector<double> values;
      values.reserve(nodes.size());
      for (const NodeId node : nodes) values.push_back(monitor.reference_surface->from(state.positions[node.index()]));
      return values;
    }
    default:
      return {};
  }
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

// Apical load of all cells, Pa.
std::vector<double> apical_loads(const Moment& moment) {
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
  return of_cells;
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

std::vector<double> cell_values(const Monitor& monitor, const Moment& moment) {
  if (monitor.quantity == Quantity::apical_elongation) return elongations(monitor, moment);
  if (monitor.quantity == Quantity::inward_displacement) return inward_displacements(monitor, moment);
  const Tissue& tissue = moment.model.tissue;
  std::vector<double> of_all;
  if (monitor.quantity == Quantity::volume) of_all = moment.model.volumes.volumes(moment.state.positions);
  if (monitor.quantity == Quantity::area)
    of_all = monitor.face == Monitor::Face::basal ? basal_areas(tissue, moment.state.positions)
                                                  : apical_areas(tissue, moment.state.positions);
  if (monitor.quantity == Quantity::area_ratio) {
    of_all = apical_areas(tissue, moment.state.positions);
    const std::vector<double> at_rest = rest_apical_areas(tissue);
    for (std::size_t c = 0; c < of_all.size(); ++c) of_all[c] /= at_rest[c];
  }
  if (monitor.quantity == Quantity::apical_load) of_all = apical_loads(moment);
  if (monitor.quantity == Quantity::pressure && moment.model.volumes.is_held())
    for (const double pressure : moment.state.pressures(moment.model)) of_all.push_back(pressure / units::pascal);
  std::vector<double> values;
  if (of_all.empty()) return values;
  for (const CellId cell : monitored_cells(monitor, tissue)) values.push_back(of_all[cell.index()]);
  return values;
}

std::vector<double> region_values(const Monitor& monitor, const Moment& moment) {
  switch (monitor.quantity) {
    case Quantity::relative_energy_norm:
      return energy_norm_values(monitor, moment);
    case Quantity::kinetic_energy:
      return kinetic_energy_values(monitor, moment);
    case Quantity::time:
      return {moment.state.time_s};
    case Quantity::wall:
      return {moment.wall_s};
    default:
      return {};
  }
}

}  // namespace

std::span<const QuantityInfo> quantities() { return table; }

const QuantityInfo& info_of(Quantity quantity) { return table[static_cast<std::size_t>(quantity)]; }

const QuantityInfo* quantity_named(std::string_view name) {
  const auto found = std::ranges::find(table, name, &QuantityInfo::name);
  return found == table.end() ? nullptr : &*found;
}

std::string Monitor::column() const {
  const QuantityInfo& info = info_of(quantity);
  return fmt::format("{}.{}{}{}", name, info.name, info.unit.empty() ? "" : "_", info.unit);
}

std::vector<NodeId> monitored_nodes(const Monitor& monitor, const Tissue& tissue) {
  const CellSet& region = tissue.regions.at(monitor.region);
  std::vector<bool> monitored(tissue.node_count(), false);
  if (monitor.face == Monitor::Face::any) {
    for (std::size_t e = 0; e < tissue.elements.size(); ++e)
      if (region[tissue.element_cell[e].index()])
        for (const NodeId node : tissue.elements[e]) monitored[node.index()] = true;
  } else {
    for (const Facet& facet : monitor.face == Monitor::Face::apical ? tissue.apical_facets : tissue.basal_facets)
      if (region[facet.cell.index()])
        for (const NodeId node : facet.nodes) monitored[node.index()] = true;
  }
  std::vector<NodeId> nodes;
  for (std::size_t n = 0; n < monitored.size(); ++n)
    if (monitored[n]) nodes.emplace_back(n);
  return nodes;
}

std::vector<CellId> monitored_cells(const Monitor& monitor, const Tissue& tissue) {
  using enum Quantity;
  CellSet chosen = tissue.regions.at(monitor.region);
  if (std::ranges::count(std::array{area, area_ratio, apical_elongation, apical_load, inward_displacement},
                         monitor.quantity) > 0) {
    CellSet has_side(chosen.size(), false);
    for (const Facet& facet : monitor.face == Monitor::Face::basal ? tissue.basal_facets : tissue.apical_facets)
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
  const Info::Of of = info_of(monitor.quantity).of;
  const auto values_of = of == Info::Of::node ? node_values : of == Info::Of::cell ? cell_values : region_values;
  const std::vector<double> values = values_of(monitor, moment);
  return {values, combined(monitor.over, values)};
}

}  // namespace plica
