// Both functions first scale the unknown, l = s t with s = -c0/c1, the root of the linear part:
//   A t^3 + B t^2 + t - 1 = 0,   A = c3 s^2 / c1,  B = c2 s / c1.
// For a volume that is nearly right A and B are tiny and t is near 1, where Cardano's formula would lose all digits: it
// subtracts roots as large as 1/B. So the root is found by Newton's method between the points where the cubic turns.
#include "solver/projection/cubic.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace plica {
namespace {

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
