#include "measure/smooth_outcome.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "core/errors.hpp"
#include "measure/cells.hpp"
#include "measure/closing.hpp"
#include "measure/furrow.hpp"
#include "measure/region_shape.hpp"
#include "measure/surface_distance.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

/// Derivatives of a monitor by its values, one per item; of an extremum those of the item that has it.
std::vector<double> slopes_of_reduction(Over over, std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  std::vector<double> slopes(values.size(), over == Over::sum ? 1 : over == Over::mean ? 1 / count : 0);
  if (over == Over::rms)
    for (std::size_t i = 0; i < slopes.size(); ++i)
      slopes[i] = values[i] / (count * combined(over, values).value_or(1));
  if (over == Over::max) slopes[static_cast<std::size_t>(std::ranges::max_element(values) - values.begin())] = 1;
  if (over == Over::min) slopes[static_cast<std::size_t>(std::ranges::min_element(values) - values.begin())] = 1;
  return slopes;
}

bool is_smooth(const Monitor& monitor) {
  constexpr std::array quantities = {"position", "displacement", "surface_distance",    "volume",
                                     "area",     "area_ratio",   "inward_displacement", "depth"};
  return std::ranges::count(quantities, monitor.quantity->name) > 0;
}

void add_mean_apical_gradient(const Cell& cell, const Vec3& by_mean, std::span<Vec3> gradient) {
  for (const NodeId corner : cell.apical_corners())
    gradient[corner.index()] += by_mean / static_cast<double>(cell.sides());
}

/// Derivative of the distance of a place from a surface: central differences, since it is piecewise linear or
/// quadratic.
Vec3 distance_gradient(const SurfaceDistance& surface, const Vec3& place) {
  constexpr double step_um = 1e-4;
  Vec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = step_um * Vec3::Unit(axis);
    gradient[axis] = (surface.from(place + step) - surface.from(place - step)) / (2 * step_um);
  }
  return gradient;
}

SmoothOutcome of_monitor(const Monitor& monitor, const Model& model, const Vectors& positions) {
  State state;
  state.positions = positions;
  const Reading reading = read_monitor(monitor, {model, state});
  const Tissue& tissue = model.tissue;
  if (!reading.number) throw UsageError(fmt::format("outcome \"{}\": has no value here", monitor.column()));
  SmoothOutcome outcome{*reading.number, Vectors(positions.size(), Vec3::Zero())};
  const std::vector<double> slopes = slopes_of_reduction(monitor.over, reading.values);
  const std::string_view quantity = monitor.quantity->name;
  if (monitor.quantity->of == Quantity::Of::node) {
    const std::vector<NodeId> nodes = monitored_nodes(monitor, tissue);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (slopes[i] == 0) continue;
      const std::size_t n = nodes[i].index();
      outcome.gradient[n] +=
          slopes[i] * (quantity == "surface_distance" ? distance_gradient(*monitor.reference_surface, positions[n])
                       : monitor.axis                 ? Vec3(Vec3::Unit(*monitor.axis))
                                                      : (positions[n] - tissue.rest_positions[n]).stableNormalized());
    }
    return outcome;
  }
  const std::vector<CellId> cells = monitored_cells(monitor, tissue);
  if (quantity == "inward_displacement" || quantity == "depth") {
    const std::vector<Vec3> normals = rest_apical_normals(tissue, cells);
    CellsAround around;
    if (quantity == "depth") around = cells_around_region(tissue, tissue.regions.at(monitor.region), cells);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      add_mean_apical_gradient(tissue.cells[cells[i].index()], -slopes[i] * normals[i], outcome.gradient);
      for (std::size_t k = 0; k < around.cells.size(); ++k)
        add_mean_apical_gradient(tissue.cells[around.cells[k].index()], slopes[i] * around.weights[i][k] * normals[i],
                                 outcome.gradient);
    }
    return outcome;
  }
  std::vector<double> weights(tissue.cells.size(), 0.0);
  for (std::size_t i = 0; i < cells.size(); ++i) weights[cells[i].index()] = slopes[i];
  if (quantity == "volume") {
    model.volumes.add_forces(positions, weights, outcome.gradient);
    return outcome;
  }
  const CellSide side = monitor.face.value_or(CellSide::apical);
  if (quantity == "area_ratio") {
    const std::vector<double> at_rest = rest_face_areas(tissue, side);
    for (const CellId cell : cells) weights[cell.index()] /= at_rest[cell.index()];
  }
  add_area_gradient(tissue, side, positions, weights, outcome.gradient);
  return outcome;
}

/// What outcomes read.
struct Place {
  const Model& model;
  const FurrowSites* sites;  // null without a furrow
  const Vectors& positions;

  [[nodiscard]] SmoothOutcome begun(double value) const { return {value, Vectors(positions.size(), Vec3::Zero())}; }
};

// The deepest point is where a line of its facet, an edge or from a corner to the centre, meets the plane y = 0. When
// nodes move, it moves along that line, so as to stay in the plane.
std::optional<SmoothOutcome> furrow_depth(const Place& here) {
  if (here.sites == nullptr) return std::nullopt;
  const auto& [model, kept, positions] = here;
  const Tissue& tissue = model.tissue;
  const FurrowSites& sites = *kept;
  SmoothOutcome outcome = here.begun(0);
  const std::optional<SurfacePoint> deepest = deepest_point(tissue, sites, positions);
  if (!deepest) return outcome;
  outcome.value = furrow_depth_um(tissue, sites, positions).value_or(0);
  const Vec3 place = deepest->at(positions);
  Vec3 by_place;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 step = 1e-4 * Vec3::Unit(axis);
    by_place[axis] =
        (inward_depth_um(tissue, sites, place + step) - inward_depth_um(tissue, sites, place - step)) / 2e-4;
  }
  const auto largest = std::ranges::max_element(deepest->weights);
  const Vec3 corner = positions[deepest->nodes[static_cast<std::size_t>(largest - deepest->weights.begin())].index()];
  const Vec3 along = place - corner;
  Vec3 by_node = by_place;
  if (std::abs(along.y()) > 1e-9)
    by_node.y() -= by_place.dot(along) / along.y();
  else
    by_node.y() = 0;
  for (int i = 0; i < 4; ++i) outcome.gradient[deepest->nodes[i].index()] += deepest->weights[i] * by_node;
  return outcome;
}

SmoothOutcome volume_ratio(const Place& here, const EnclosedVolume& volume) {
  SmoothOutcome outcome = here.begun(volume.ratio(here.positions));
  volume.add_forces(here.positions, std::array{1 / volume.targets().front()}, outcome.gradient);
  return outcome;
}

std::optional<SmoothOutcome> enclosed_volume_ratio(const Place& here) {
  const EnclosedFluid* fluid = enclosed_fluid(here.model).fluid;
  if (fluid == nullptr) return std::nullopt;
  return volume_ratio(here, fluid->volume());
}

std::optional<SmoothOutcome> lumen_volume_ratio(const Place& here) {
  const Tissue& tissue = here.model.tissue;
  if (!lumen_volume(tissue, tissue.rest_positions)) return std::nullopt;
  return volume_ratio(here, EnclosedVolume(tissue));
}

SmoothOutcome apical_area_ratio(const Place& here, const MonitoredCells& cells) {
  const Tissue& tissue = here.model.tissue;
  const std::vector<double> at_rest = rest_face_areas(tissue, CellSide::apical);
  std::vector<double> weights(at_rest.size(), 0.0);
  for (const CellId cell : cells)
    weights[cell.index()] += 1 / (at_rest[cell.index()] * static_cast<double>(cells.size()));
  SmoothOutcome outcome = here.begun(mean_apical_area_ratio(tissue, cells, here.positions));
  add_area_gradient(tissue, CellSide::apical, here.positions, weights, outcome.gradient);
  return outcome;
}

/// Return the mean height of cells.
SmoothOutcome height(const Place& here, const MonitoredCells& cells) {
  SmoothOutcome outcome = here.begun(0);
  for (const CellId id : cells) {
    const Cell& cell = here.model.tissue.cells[id.index()];
    const std::size_t sides = cell.sides();
    const double weight = 1 / static_cast<double>(cells.size());
    outcome.value += weight * cell_height(cell, here.positions);
    for (std::size_t i = 0; i < sides; ++i) {
      const std::size_t apex = cell.corners[i + sides].index(), base = cell.corners[i].index();
      const Vec3 along = (here.positions[apex] - here.positions[base]).normalized();
      outcome.gradient[apex] += weight / static_cast<double>(sides) * along;
      outcome.gradient[base] -= weight / static_cast<double>(sides) * along;
    }
  }
  return outcome;
}

std::optional<SmoothOutcome> mean_height(const Place& here) {
  MonitoredCells all;
  for (std::size_t c = 0; c < here.model.tissue.cells.size(); ++c) all.emplace_back(c);
  return height(here, all);
}

std::optional<SmoothOutcome> lip_distance(const Place& here) {
  if (here.sites == nullptr || !here.sites->has_lips) return std::nullopt;
  const auto& [left, right] = here.sites->lips;
  const Vec3 apart = right.at(here.positions) - left.at(here.positions);
  SmoothOutcome outcome = here.begun(apart.norm());
  for (std::size_t i = 0; i < 4; ++i) {
    outcome.gradient[right.nodes[i].index()] += right.weights[i] * apart.normalized();
    outcome.gradient[left.nodes[i].index()] -= left.weights[i] * apart.normalized();
  }
  return outcome;
}

/// Apply a function of the place and cells to cells of the furrow.
template <auto function, auto cells>
std::optional<SmoothOutcome> of_cells(const Place& here) {
  if (here.sites == nullptr) return std::nullopt;
  return function(here, here.sites->*cells);
}

struct NamedOutcome {
  std::string_view name;
  std::optional<SmoothOutcome> (*at)(const Place&);  // nothing where it does not exist
  bool is_relative_to_rest = false;                  // to the tissue's reference state, which division makes again
};

constexpr std::array named_outcomes = {
    NamedOutcome{"furrow_depth_um", furrow_depth},
    NamedOutcome{"vml_apical_area_ratio", of_cells<apical_area_ratio, &FurrowSites::vml>, true},
    NamedOutcome{"vce_apical_area_ratio", of_cells<apical_area_ratio, &FurrowSites::vce>, true},
    NamedOutcome{"vml_height_um", of_cells<height, &FurrowSites::vml>},
    NamedOutcome{"lip_distance_um", lip_distance},
    NamedOutcome{"mean_height_um", mean_height},
    NamedOutcome{"enclosed_volume_ratio", enclosed_volume_ratio},
    NamedOutcome{"lumen_volume_ratio", lumen_volume_ratio, true},
};

}  // namespace

void add_area_gradient(const Tissue& tissue, CellSide side, std::span<const Vec3> positions,
                       std::span<const double> weights, std::span<Vec3> gradient) {
  for (const Facet& facet : tissue.facets(side)) {
    const double weight = weights[facet.cell.index()];
    if (weight == 0) continue;
    const std::array<Vec3, 4> by_corner = facet_area_gradient(gather(positions, facet));
    for (int i = 0; i < 4; ++i) gradient[facet.nodes[i].index()] += weight * by_corner[i];
  }
}

bool is_relative_to_rest(const std::string& name, const MeasurePlan& plan) {
  constexpr std::array quantities = {"displacement", "area_ratio", "inward_displacement", "depth"};
  const auto* named = std::ranges::find(named_outcomes, name, &NamedOutcome::name);
  return (named != named_outcomes.end() && named->is_relative_to_rest) ||
         std::ranges::any_of(plan.monitors, [&](const Monitor& monitor) {
           return name == monitor.column() && std::ranges::count(quantities, monitor.quantity->name) > 0;
         });
}

SmoothOutcome smooth_outcome(const std::string& name, const Model& model, const MeasurePlan& plan,
                             const Vectors& positions) {
  const auto kept = plan.sets.find("furrow");
  const Place here{model, kept == plan.sets.end() ? nullptr : std::any_cast<FurrowSites>(&kept->second), positions};
  const auto* found = std::ranges::find(named_outcomes, name, &NamedOutcome::name);
  if (found != named_outcomes.end())
    if (std::optional<SmoothOutcome> outcome = found->at(here)) return *outcome;
  for (const Monitor& monitor : plan.monitors)
    if (name == monitor.column() && is_smooth(monitor)) return of_monitor(monitor, model, positions);
  std::vector<std::string> names;
  for (const NamedOutcome& named : named_outcomes)
    if (named.at(here)) names.emplace_back(named.name);
  for (const Monitor& monitor : plan.monitors)
    if (is_smooth(monitor)) names.push_back(monitor.column());
  const bool is_column = std::ranges::any_of(columns(), [&](const Column& column) { return column.name == name; }) ||
                         std::ranges::any_of(plan.monitors, [&](const Monitor& m) { return m.column() == name; });
  throw UsageError(
      fmt::format("outcome \"{}\": {}; those with a gradient: {}; add a monitor of area, area_ratio, volume, position, "
                  "displacement, inward_displacement, depth or surface_distance",
                  name, is_column ? "has no gradient" : "is no output variable",
                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace plica
