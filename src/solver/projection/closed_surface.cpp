#include "solver/projection/closed_surface.hpp"

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

}  // namespace plica
