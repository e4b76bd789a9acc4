#include "measure/cells.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

#include "mechanics/energy.hpp"

namespace plica {

double cell_height(const Cell& cell, std::span<const Vec3> positions) {
  const std::size_t sides = cell.sides();
  double sum = 0;
  for (std::size_t i = 0; i < sides; ++i)
    sum += (positions[cell.corners[i + sides].index()] - positions[cell.corners[i].index()]).norm() /
           static_cast<double>(sides);
  return sum;
}

double mean_speed(const Tissue& tissue, const MonitoredCells& cells, const Vectors& velocities) {
  double sum = 0;
  for (const CellId id : cells) sum += cell_centre(tissue.cells[id.index()], velocities).norm();
  return sum / static_cast<double>(cells.size());
}

double mean_node_displacement(const Tissue& tissue, const MonitoredCells& cells, const Vectors& positions) {
  double sum = 0;
  for (const CellId id : cells)
    for (const std::vector<NodeId>& corners = tissue.cells[id.index()].corners; const NodeId node : corners)
      sum +=
          (positions[node.index()] - tissue.rest_positions[node.index()]).norm() / static_cast<double>(corners.size());
  return sum / static_cast<double>(cells.size());
}

double mean_apical_area_ratio(const Tissue& tissue, const MonitoredCells& cells, std::span<const Vec3> positions) {
  const std::vector<double> now = face_areas(tissue, CellSide::apical, positions),
                            rest = rest_face_areas(tissue, CellSide::apical);
  double sum = 0;
  for (const CellId cell : cells) sum += now[cell.index()] / rest[cell.index()];
  return sum / static_cast<double>(cells.size());
}

std::optional<double> min_apical_area_ratio(const Tissue& tissue, std::span<const Vec3> positions) {
  const std::vector<double> now = face_areas(tissue, CellSide::apical, positions),
                            rest = rest_face_areas(tissue, CellSide::apical);
  std::optional<double> least;
  for (std::size_t c = 0; c < now.size(); ++c)
    if (rest[c] > 0) least = std::min(least.value_or(now[c] / rest[c]), now[c] / rest[c]);
  return least;
}

std::size_t short_edges(const Tissue& tissue, std::span<const Vec3> positions) {
  constexpr double short_ratio = 0.1;
  std::vector<std::pair<NodeId, NodeId>> found;  // a shared edge occurs twice
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges) {
      if (edge.side != CellSide::apical) continue;
      const NodeId a = edge.nodes.front(), b = edge.nodes.back();
      const double now = (positions[b.index()] - positions[a.index()]).norm(),
                   at_rest = (tissue.rest_positions[b.index()] - tissue.rest_positions[a.index()]).norm();
      if (now < short_ratio * at_rest) found.emplace_back(std::min(a, b), std::max(a, b));
    }
  std::ranges::sort(found);
  return static_cast<std::size_t>(std::unique(found.begin(), found.end()) - found.begin());
}

std::vector<double> activities(const Model& model, const State& state) {
  std::vector<double> result(model.tissue.cells.size(), 0.0);
  for (std::size_t l = model.laws.size(); l-- > 0;)
    for (std::size_t c = 0; model.laws[l]->is_active() && c < result.size(); ++c)
      if (const auto activity = model.laws[l]->activity_of(CellId(c), state.time_s, state.internals[l]))
        result[c] = *activity;
  return result;
}

std::vector<double> strengths(const Model& model) {
  std::vector<double> result(model.tissue.cells.size(), 0.0);
  for (std::size_t l = model.laws.size(); l-- > 0;) {
    const CellPattern* pattern = model.laws[l]->is_active() ? model.laws[l]->pattern() : nullptr;
    if (pattern == nullptr || pattern->cells.empty()) continue;
    for (std::size_t c = 0; c < result.size(); ++c)
      if (pattern->cells[c]) result[c] = pattern->strengths[c];
  }
  return result;
}

namespace {

// Volume inside outward-oriented facets; empty for an open surface.
std::optional<double> volume_inside(std::span<const Facet> facets, std::span<const Vec3> positions) {
  Vec3 area_vector = Vec3::Zero();
  double volume = 0, area = 0;
  for (const Facet& facet : facets) {
    const auto [a, b, c, d] = gather(positions, facet);
    // Cone from the origin, as in hex_volume.
    volume += (a.dot(b.cross(c)) + a.dot(c.cross(d)) + a.dot(b.cross(d)) + b.dot(c.cross(d))) / 12;
    const Vec3 of_facet = facet_area_vector({a, b, c, d});
    area_vector += of_facet;
    area += of_facet.norm();
  }
  if (facets.empty() || area_vector.norm() > 1e-9 * area) return std::nullopt;
  return volume;
}

}  // namespace

std::optional<double> lumen_volume(const Tissue& tissue, std::span<const Vec3> positions) {
  // Basal facets are oriented into the lumen.
  const std::optional<double> volume = volume_inside(tissue.basal_facets, positions);
  return volume ? std::optional(-*volume) : std::nullopt;
}

std::optional<double> volume_inside_apices(const Tissue& tissue, std::span<const Vec3> positions) {
  return volume_inside(tissue.apical_facets, positions);
}

double shell_penetration(const Model& model, std::span<const Vec3> positions) {
  double deepest = 0;
  for (const auto& obstacle : model.obstacles)
    for (const NodeId n : obstacle->nodes()) deepest = std::max(deepest, -obstacle->gap(positions[n.index()]).value);
  return deepest;
}

double tissue_volume(const Model& model, std::span<const Vec3> positions) {
  const std::vector<double> volumes = model.volumes.volumes(positions);
  return std::accumulate(volumes.begin(), volumes.end(), 0.0);
}

double mean_height(const Tissue& tissue, std::span<const Vec3> positions) {
  double sum = 0;
  for (const Cell& cell : tissue.cells) sum += cell_height(cell, positions);
  return sum / static_cast<double>(tissue.cells.size());
}

double max_displacement(const Tissue& tissue, std::span<const Vec3> positions) {
  double largest = 0;
  for (std::size_t n = 0; n < positions.size(); ++n)
    largest = std::max(largest, (positions[n] - tissue.rest_positions[n]).squaredNorm());
  return std::sqrt(largest);
}

double max_volume_error(const Model& model, std::span<const Vec3> positions) {
  double largest = 0;
  for (const double error : model.volumes.relative_errors(positions)) largest = std::max(largest, std::abs(error));
  return largest;
}

namespace {

// Static forces on free nodes.
template <class Counts>
Vectors forces_of_laws(const Model& model, const State& state, const Counts& counts) {
  Vectors forces(state.positions.size(), Vec3::Zero());
  const Vectors no_velocity = forces;
  for_laws(model, motionless(state, no_velocity), [&](const Law& law, const Step& law_step) {
    if (counts(law)) law.add_forces(law_step, forces);
  });
  model.tissue.carry_hanging(forces);
  return forces;
}

}  // namespace

Vectors active_forces(const Model& model, const State& state) {
  return forces_of_laws(model, state, std::mem_fn(&Law::is_active));
}

Vectors forces_of_law(const Model& model, const State& state, const Law& law) {
  return forces_of_laws(model, state, [&](const Law& other) { return &other == &law; });
}

Vectors driving_forces(const Model& model, const State& state) {
  return forces_of_laws(model, state, [](const Law&) { return true; });
}

std::vector<std::pair<std::string, double>> mean_tensions(const Model& model, const State& state) {
  std::vector<std::pair<std::string, double>> result;
  for_laws(model, motionless(state, state.velocities), [&](const Law& law, const Step& law_step) {
    if (const auto tension = law.mean_tension(law_step)) result.emplace_back(law.label(), *tension);
  });
  return result;
}

std::vector<Vec3> rest_apical_normals(const Tissue& tissue, std::span<const CellId> cells) {
  std::vector<Vec3> of_all(tissue.cells.size(), Vec3::Zero());
  for (const Facet& facet : tissue.apical_facets)
    of_all[facet.cell.index()] += facet_area_vector(gather(tissue.rest_positions, facet));
  std::vector<Vec3> normals;
  normals.reserve(cells.size());
  for (const CellId cell : cells) normals.push_back(of_all[cell.index()].normalized());
  return normals;
}

Vec3 mean_apical(const Cell& cell, std::span<const Vec3> vectors) {
  Vec3 sum = Vec3::Zero();
  for (const NodeId corner : cell.apical_corners()) sum += vectors[corner.index()] / static_cast<double>(cell.sides());
  return sum;
}

}  // namespace plica
