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
#include "mechanics/constraints/enclosed_volume.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

/// Derivatives of a monitor by its values, one per item; empty if it is not smooth.
std::vector<double> slopes_of_reduction(Over over, std::span<const double> values) {
  const auto count = static_cast<double>(values.size());
  if (over == Over::sum) return std::vector<double>(values.size(), 1);
  if (over == Over::mean) return std::vector<double>(values.size(), 1 / count);
  if (over != Over::rms) return {};
  std::vector<double> slopes;
  for (const double value : values) slopes.push_back(value / (count * combined(over, values).value_or(1)));
  return slopes;
}

bool is_smooth(const Monitor& monitor) {
  constexpr std::array quantities = {"position", "displacement", "volume", "area", "area_ratio"};
  return std::ranges::count(quantities, monitor.quantity->name) > 0 && monitor.over != Over::min &&
         monitor.over != Over::max;
}

SmoothOutcome of_monitor(const Monitor& monitor, const Model& model, const Vectors& positions) {
  State state;
  state.positions = positions;
  const Reading reading = read_monitor(monitor, {model, state});
  const std::vector<double> slopes = slopes_of_reduction(monitor.over, reading.values);
  const Tissue& tissue = model.tissue;
  SmoothOutcome outcome{reading.number.value_or(0), Vectors(positions.size(), Vec3::Zero())};
  if (monitor.quantity->of == Quantity::Of::node) {
    const std::vector<NodeId> nodes = monitored_nodes(monitor, tissue);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const std::size_t n = nodes[i].index();
      const Vec3 direction =
          monitor.axis ? Vec3(Vec3::Unit(*monitor.axis)) : (positions[n] - tissue.rest_positions[n]).stableNormalized();
      outcome.gradient[n] += slopes[i] * direction;
    }
    return outcome;
  }
  const std::vector<CellId> cells = monitored_cells(monitor, tissue);
  std::vector<double> weights(tissue.cells.size(), 0.0);
  for (std::size_t i = 0; i < cells.size(); ++i) weights[cells[i].index()] = slopes[i];
  if (monitor.quantity->name == "volume") {
    model.volumes.add_forces(positions, weights, outcome.gradient);
    return outcome;
  }
  const CellSide side = monitor.face.value_or(CellSide::apical);
  if (monitor.quantity->name == "area_ratio") {
    const std::vector<double> at_rest = rest_face_areas(tissue, side);
    for (const CellId cell : cells) weights[cell.index()] /= at_rest[cell.index()];
  }
  add_area_gradient(tissue, side, positions, weights, outcome.gradient);
  return outcome;
}

// The deepest point is where a line of its facet, an edge or from a corner to the centre, meets the plane y = 0. When
// nodes move, it moves along that line, so as to stay in the plane.
SmoothOutcome furrow_depth(const Tissue& tissue, const FurrowSites& sites, const Vectors& positions) {
  SmoothOutcome outcome{0, Vectors(positions.size(), Vec3::Zero())};
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

std::optional<SmoothOutcome> enclosed_volume_ratio(const Model& model, const Vectors& positions) {
  const EnclosedFluid* fluid = enclosed_fluid(model).fluid;
  if (fluid == nullptr) return std::nullopt;
  const EnclosedVolume& volume = fluid->volume();
  SmoothOutcome outcome{volume.ratio(positions), Vectors(positions.size(), Vec3::Zero())};
  volume.add_forces(positions, std::array{1 / volume.targets().front()}, outcome.gradient);
  return outcome;
}

SmoothOutcome apical_area_ratio(const Tissue& tissue, const MonitoredCells& cells, const Vectors& positions) {
  const std::vector<double> at_rest = rest_face_areas(tissue, CellSide::apical);
  std::vector<double> weights(at_rest.size(), 0.0);
  for (const CellId cell : cells)
    weights[cell.index()] += 1 / (at_rest[cell.index()] * static_cast<double>(cells.size()));
  SmoothOutcome outcome{mean_apical_area_ratio(tissue, cells, positions), Vectors(positions.size(), Vec3::Zero())};
  add_area_gradient(tissue, CellSide::apical, positions, weights, outcome.gradient);
  return outcome;
}

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
  return name == "vml_apical_area_ratio" || std::ranges::any_of(plan.monitors, [&](const Monitor& monitor) {
           return name == monitor.column() &&
                  (monitor.quantity->name == "displacement" || monitor.quantity->name == "area_ratio");
         });
}

SmoothOutcome smooth_outcome(const std::string& name, const Model& model, const MeasurePlan& plan,
                             const Vectors& positions) {
  const auto kept = plan.sets.find("furrow");
  const auto* sites = kept == plan.sets.end() ? nullptr : std::any_cast<FurrowSites>(&kept->second);
  if (sites != nullptr && name == "furrow_depth_um") return furrow_depth(model.tissue, *sites, positions);
  if (sites != nullptr && name == "vml_apical_area_ratio")
    return apical_area_ratio(model.tissue, sites->vml, positions);
  const auto enclosed = enclosed_volume_ratio(model, positions);
  if (enclosed && name == "enclosed_volume_ratio") return *enclosed;
  std::vector<std::string> names;
  if (sites != nullptr) names = {"furrow_depth_um", "vml_apical_area_ratio"};
  if (enclosed) names.emplace_back("enclosed_volume_ratio");
  for (const Monitor& monitor : plan.monitors) {
    if (!is_smooth(monitor)) continue;
    if (name == monitor.column()) return of_monitor(monitor, model, positions);
    names.push_back(monitor.column());
  }
  const bool is_column = std::ranges::any_of(columns(), [&](const Column& column) { return column.name == name; }) ||
                         std::ranges::any_of(plan.monitors, [&](const Monitor& m) { return m.column() == name; });
  throw UsageError(
      fmt::format("outcome \"{}\": {}; those with a gradient: {}; add a monitor of area, area_ratio, volume, position "
                  "or displacement over mean, sum or rms",
                  name, is_column ? "has no gradient" : "is no output variable",
                  names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", "))));
}

}  // namespace plica
