#include "solver/projection/volume_projection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace plica {
namespace {

std::vector<ClosedSurface::Quad> quads_of(std::span<const Facet> facets) {
  std::vector<ClosedSurface::Quad> quads;
  for (const Facet& facet : facets) quads.push_back(facet.nodes);
  return quads;
}

// Both functions first scale the unknown, l = s t with s = -c0/c1, the root of the linear part:
//   A t^3 + B t^2 + t - 1 = 0,   A = c3 s^2 / c1,  B = c2 s / c1.
// For a volume that is nearly right A and B are tiny and t is near 1, where Cardano's formula would lose all digits: it
// subtracts roots as large as 1/B. So the root is found by Newton's method between the points where the cubic turns.
constexpr double infinity = std::numeric_limits<double>::infinity();

Cubic scaled(const Cubic& cubic, double s) { return {cubic.c3 * s * s / cubic.c1, cubic.c2 * s / cubic.c1, 1, -1}; }

// The root between `low` and `high`, where the signs differ: Newton's method, bisection where that leads outside.
double root_between(const Cubic& cubic, double low, double high, double start) {
  const double sign = cubic.at(low) < 0 ? 1 : -1;
  double t = start;
  for (int iteration = 0; iteration < 200; ++iteration) {
    const double value = cubic.at(t);
    (sign * value < 0 ? low : high) = t;
    double next = t - value / cubic.slope(t);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::abs(next - t) <= 4 * std::numeric_limits<double>::epsilon() * std::abs(next)) return next;
    t = next;
  }
  return t;
}

// Zeros of the slope, in order; infinite if there are none.
std::array<double, 2> turning_points(const Cubic& c) {
  const double discriminant = c.c2 * c.c2 - 3 * c.c3 * c.c1;
  if (!(discriminant > 0)) return {-infinity, infinity};
  const double q = -(c.c2 + std::copysign(std::sqrt(discriminant), c.c2));
  const double a = c.c1 / q, b = c.c3 != 0 ? q / (3 * c.c3) : std::copysign(infinity, -a);
  return {std::min(a, b), std::max(a, b)};
}

void add_facets(const std::array<NodeId, 8>& element, std::vector<ClosedSurface::Quad>& facets) {
  for (const auto& face : hex_faces)
    facets.push_back({element[face[0]], element[face[1]], element[face[2]], element[face[3]]});
}

double volume_inside(const ClosedSurface& surface, const Vectors& positions) {
  Vectors points, gradient;
  surface.gather(positions, points);
  surface.gradient(points, gradient);
  return dot(points, gradient) / 3;
}

}  // namespace

ClosedSurface::ClosedSurface(std::span<const Facet> facets) : ClosedSurface(quads_of(facets)) {}

ClosedSurface::ClosedSurface(const std::vector<Quad>& facets) {
  // A shared facet comes with the same nodes from both sides.
  std::map<Quad, std::vector<std::size_t>> alike;
  for (std::size_t f = 0; f < facets.size(); ++f) {
    Quad sorted = facets[f];
    std::sort(sorted.begin(), sorted.end());
    alike[sorted].push_back(f);
  }
  std::vector<char> inner(facets.size(), 0);
  for (const auto& [nodes, places] : alike)
    if (places.size() == 2) inner[places[0]] = inner[places[1]] = 1;
  for (std::size_t f = 0; f < facets.size(); ++f)
    if (!inner[f]) nodes_.insert(nodes_.end(), facets[f].begin(), facets[f].end());
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  for (std::size_t f = 0; f < facets.size(); ++f) {
    if (inner[f]) continue;
    std::array<int, 4>& places = facets_.emplace_back();
    for (int i = 0; i < 4; ++i)
      places[i] = static_cast<int>(std::lower_bound(nodes_.begin(), nodes_.end(), facets[f][i]) - nodes_.begin());
  }
}

void ClosedSurface::gather(std::span<const Vec3> positions, Vectors& points) const {
  points.resize(nodes_.size());
  const Vec3& origin = positions[nodes_.front().index()];
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = positions[nodes_[i].index()] - origin;
}

void ClosedSurface::gradient(const Vectors& points, Vectors& gradient) const {
  gradient.assign(nodes_.size(), Vec3::Zero());
  for (const auto& [ia, ib, ic, id] : facets_) {
    const Vec3 &a = points[ia], &b = points[ib], &c = points[ic], &d = points[id];
    // b x c + c x d + b x d for a, and so on around the facet.
    const Vec3 bd = b.cross(d), ca = c.cross(a);
    gradient[ia] += (b - d).cross(c) + bd;
    gradient[ib] += (c - a).cross(d) + ca;
    gradient[ic] += (d - b).cross(a) - bd;
    gradient[id] += (a - c).cross(b) - ca;
  }
  for (Vec3& of_node : gradient) of_node *= 1.0 / 12;
}

Cubic ClosedSurface::volume_along(const Vectors& points, const Vectors& gradient, const Vectors& direction,
                                  Vectors& scratch) const {
  this->gradient(direction, scratch);
  return {dot(direction, scratch) / 3, dot(points, scratch), dot(gradient, direction), dot(points, gradient) / 3};
}

std::optional<double> root_nearest_zero(const Cubic& cubic) {
  if (cubic.c0 == 0) return 0;
  const double s = -cubic.c0 / cubic.c1;
  const Cubic f = scaled(cubic, s);
  // The usual case: nearly linear. With both at most 0.05, f rises on [-2, 2] from below zero at 0 to above it at 2.
  if (std::abs(f.c3) < 0.05 && std::abs(f.c2) < 0.05) return s * root_between(f, 0, 2, 1);
  // All roots lie within Cauchy's bound, and one at most between two of these.
  const double lead = f.c3 != 0 ? f.c3 : f.c2 != 0 ? f.c2 : f.c1;
  const double bound = std::min(1e100, 1 + std::max(std::abs(f.c2), 1.0) / std::abs(lead));
  const auto [first, second] = turning_points(f);
  const std::array<double, 4> ends = {-bound, std::clamp(first, -bound, bound), std::clamp(second, -bound, bound),
                                      bound};
  std::optional<double> nearest;
  const auto look_between = [&](double low, double high, double start) {
    if (!(low < high) || (f.at(low) < 0) == (f.at(high) < 0)) return;
    const double root = root_between(f, low, high, start);
    if (!nearest || std::abs(root) < std::abs(*nearest)) nearest = root;
  };
  // First the stretch around zero: as f(0) = -1 and f rises there, its root is positive, and mostly near 1.
  for (int k = 0; k < 3; ++k)
    if (ends[k] <= 0 && ends[k + 1] >= 0) look_between(0, ends[k + 1], std::min(1.0, 0.5 * ends[k + 1]));
  for (int k = 0; k < 3; ++k) {
    const bool around_zero = ends[k] <= 0 && ends[k + 1] >= 0;
    const double closest = std::min(std::abs(ends[k]), std::abs(ends[k + 1]));
    if (!around_zero && !(nearest && closest >= std::abs(*nearest)))
      look_between(ends[k], ends[k + 1], 0.5 * (ends[k] + ends[k + 1]));
  }
  if (nearest) *nearest *= s;
  return nearest;
}

bool has_three_real_roots(const Cubic& cubic) {
  const double s = cubic.c0 != 0 ? -cubic.c0 / cubic.c1 : 0;
  if (s == 0) return cubic.c3 != 0 && cubic.c2 * cubic.c2 - 4 * cubic.c3 * cubic.c1 > 0;
  const auto [a, b, c, d] = scaled(cubic, s);
  return a != 0 && b * b - 4 * a - 18 * a * b + 4 * b * b * b - 27 * a * a > 0;
}

VolumeProjection::VolumeProjection(const Model& model, const std::optional<ProjectionRule>& rule)
    : model_(model), contacts_(model), rule_(rule.value_or(ProjectionRule{})) {
  if (!rule) return;
  const Tissue& tissue = model.tissue;
  const std::span<const double> targets = model.volumes.targets();
  std::vector<ClosedSurface::Quad> facets;
  if (rule_.surfaces == ProjectionRule::Surfaces::cells) {
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      facets.clear();
      const std::size_t first = tissue.cells[c].first_element.index();
      for (std::size_t e = first; e < first + tissue.cells[c].element_count; ++e)
        add_facets(tissue.elements[e], facets);
      volumes_.push_back({ClosedSurface(facets), targets[c], CellId(c)});
    }
  } else if (rule_.surfaces == ProjectionRule::Surfaces::tissue) {
    for (const auto& element : tissue.elements) add_facets(element, facets);
    double target = 0;
    for (const double of_cell : targets) target += of_cell;
    volumes_.push_back({ClosedSurface(facets), target, std::nullopt});
  } else {
    ClosedSurface surface(tissue.apical_facets);
    const double target = volume_inside(surface, tissue.rest_positions);
    volumes_.push_back({std::move(surface), target, std::nullopt});
  }
}

// Mobility: one over what resists a node's motion in a step, drag and mass, which the laws on single nodes say.
void VolumeProjection::set_weights(const State& before, double duration_s) {
  const std::size_t nodes = model_.tissue.node_count();
  const Vectors &at = model_.tissue.rest_positions, along_x(nodes, Vec3::UnitX()), still(nodes, Vec3::Zero());
  Step step{at, at, still, duration_s, 0};
  step.internals = before.internals;
  Vectors resistance(nodes, Vec3::Zero());
  for_laws(model_, step, [&](const Law& law, const Step& law_step) {
    if (law.node_groups(law_step.internal).empty()) law.add_tangent_product(law_step, along_x, resistance);
  });
  double sum = 0, least = 0;
  for (const Vec3& r : resistance) {
    sum += r.x();
    if (r.x() > 0 && (least == 0 || r.x() < least)) least = r.x();
  }
  weights_.assign(nodes, static_cast<double>(nodes) / (sum * duration_s));
  if (rule_.weights == ProjectionRule::Weights::equal) return;
  // An inner node without resistance gets the smallest resistance of all nodes.
  for (std::size_t n = 0; n < nodes; ++n) weights_[n] = 1 / (std::max(resistance[n].x(), least) * duration_s);
}

// Move the node of a contact inward by a distance along the normal, within its free directions.
void VolumeProjection::push(std::size_t k, double distance_um, Vectors& positions) {
  const std::size_t n = contacts_.node(k).index();
  Vec3 inward = contacts_.gap(k, positions).inward;
  for (int axis = 0; axis < 3; ++axis)
    if (model_.held[n][axis]) inward[axis] = 0;
  if (inward.norm() < 1e-6) return;  // held where the obstacle would push: the hold's business
  positions[n] += distance_um / inward.squaredNorm() * inward;
  pushed_[k] += distance_um;
}

// Move nodes beyond an obstacle back onto it. A node that was pushed and now has a gap moves back towards it, at most
// as far as it was pushed; so the result is the nearest place that satisfies obstacles and volumes, independent of the
// path.
bool VolumeProjection::project_obstacles(Vectors& positions) {
  bool moved = false;
  for (std::size_t k = 0; k < pushed_.size(); ++k) {
    const double gap = contacts_.gap(k, positions).value;
    const double distance = std::max(-gap, -pushed_[k]);
    if (std::abs(distance) <= rule_.gap_um) continue;
    const double before = pushed_[k];
    push(k, distance, positions);
    moved = moved || pushed_[k] != before;
  }
  return moved;
}

// Return V - target of a surface, and set points_, gradient_ and direction_ (of the moves of its nodes) to its own.
double VolumeProjection::volume_excess(const ProjectedVolume& volume, const Vectors& positions) {
  const std::vector<NodeId>& nodes = volume.surface.nodes();
  volume.surface.gather(positions, points_);
  volume.surface.gradient(points_, gradient_);
  direction_ = gradient_;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::size_t n = nodes[i].index();
    direction_[i] *= weights_[n];
    for (int axis = 0; axis < 3; ++axis)
      if (model_.held[n][axis]) direction_[i][axis] = 0;
  }
  return dot(points_, gradient_) / 3 - volume.target;
}

void VolumeProjection::move(std::size_t k, double l, Vectors& positions) {
  const std::vector<NodeId>& nodes = volumes_[k].surface.nodes();
  for (std::size_t i = 0; i < nodes.size(); ++i) positions[nodes[i].index()] += l * direction_[i];
  moved_[k] += l;
}

// Project the volume of one surface; true if it needed a correction.
bool VolumeProjection::project(std::size_t k, Vectors& positions, StepReport& report) {
  const ProjectedVolume& volume = volumes_[k];
  const double excess = volume_excess(volume, positions);
  if (std::abs(excess) <= rule_.tolerance * volume.target) return false;
  Cubic cubic = volume.surface.volume_along(points_, gradient_, direction_, scratch_);
  cubic.c0 = excess;
  if (!(cubic.c1 > 0)) return true;  // nothing of it can move
  ++report.cubics;
  if (has_three_real_roots(cubic)) ++report.cubics_with_three_roots;
  if (const std::optional<double> root = root_nearest_zero(cubic)) move(k, *root, positions);
  return true;
}

// Start with the corrections of the previous step, which are nearly all of it close to equilibrium.
void VolumeProjection::repeat_last_step(const State& before, double duration_s, State& after) {
  moved_.assign(volumes_.size(), 0.0);
  pushed_.assign(after.obstacle_forces.size(), 0.0);
  for (std::size_t k = 0; k < volumes_.size(); ++k)
    if (const auto& cell = volumes_[k].cell; cell && before.multipliers[cell->index()] != 0) {
      volume_excess(volumes_[k], after.positions);
      move(k, before.multipliers[cell->index()] * duration_s, after.positions);
    }
  for (std::size_t k = 0; k < pushed_.size(); ++k)
    if (const double more = before.obstacle_forces[k] - after.obstacle_forces[k]; more > 0)
      push(k, more * obstacle_weight(k, duration_s), after.positions);
}

double VolumeProjection::obstacle_weight(std::size_t k, double duration_s) const {
  return weights_[contacts_.node(k).index()] * duration_s;
}

// Remaining errors of volumes and obstacles.
void VolumeProjection::judge(const Vectors& positions, StepReport& report) const {
  report.constraint_error = report.outside_um = 0;
  for (const auto& [surface, target, cell] : volumes_) {
    const double error = std::abs(volume_inside(surface, positions) / target - 1);
    if (error <= report.constraint_error) continue;
    report.constraint_error = error;
    report.cell = cell;
  }
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    report.outside_um = std::max(report.outside_um, -contacts_.gap(k, positions).value);
}

void VolumeProjection::apply(const State& before, double duration_s, const std::function<bool()>& stop_requested,
                             State& after, StepReport& report) {
  set_weights(before, duration_s);
  repeat_last_step(before, duration_s, after);
  bool moved = true;
  for (report.projection_sweeps = 0; moved && report.projection_sweeps < rule_.most_sweeps;
       ++report.projection_sweeps) {
    if (stop_requested && stop_requested()) {
      report.status = StepReport::Status::interrupted;
      return;
    }
    moved = project_obstacles(after.positions);
    for (std::size_t k = 0; k < volumes_.size(); ++k) moved = project(k, after.positions, report) || moved;
  }
  judge(after.positions, report);
  report.status = moved ? StepReport::Status::not_projected : StepReport::Status::converged;
  if (!moved) report.cell.reset();
  for (std::size_t k = 0; k < volumes_.size(); ++k)
    if (volumes_[k].cell) after.multipliers[volumes_[k].cell->index()] += moved_[k] / duration_s;
  for (std::size_t k = 0; k < pushed_.size(); ++k) {
    after.obstacle_forces[k] += pushed_[k] / obstacle_weight(k, duration_s);
    after.on_obstacle[k] = after.obstacle_forces[k] > 0;
  }
}

}  // namespace plica
