#include "mechanics/active/wall_factors.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/active/cell_pattern.hpp"

namespace plica {

namespace {

constexpr double least_in_surface = 1e-6;  // squared length of an axis of length 1
constexpr int knots_per_correlation = 4;

std::int64_t knot_before(const WallNoise& noise, double time_s) {
  return static_cast<std::int64_t>(std::floor(time_s * knots_per_correlation / noise.correlation_s));
}

double deviate(const WallNoise& noise, std::uint64_t pair, int level, std::int64_t place) {
  return normal_deviate(noise.seed,
                        pair + static_cast<std::uint64_t>(place) + (static_cast<std::uint64_t>(level) << 60));
}

// Values of the process at a knot and at the next.
std::array<double, 2> values_about(const WallNoise& noise, std::uint64_t pair, std::int64_t knot) {
  constexpr int remembered = 12 * knots_per_correlation;
  const double correlation = std::exp(-1.0 / knots_per_correlation);
  double low = 0, weight = std::sqrt(1 - correlation * correlation);
  const double fresh = weight * deviate(noise, pair, 0, knot + 1);
  for (int k = 0; k < remembered; ++k, weight *= correlation) low += weight * deviate(noise, pair, 0, knot - k);
  return {low, correlation * low + fresh};
}

// Factor between these values, by refining the process.
double factor_between(const WallNoise& noise, std::uint64_t pair, std::array<double, 2> values, double time_s) {
  constexpr int refinements = 3;
  auto& [low, high] = values;
  std::int64_t place = knot_before(noise, time_s);
  double part = time_s * knots_per_correlation / noise.correlation_s - static_cast<double>(place),
         half = 0.5 / knots_per_correlation;
  for (int level = 1; level <= refinements; ++level, half /= 2, part *= 2) {
    // Between two values, the middle has the mean (low + high)/(2 cosh h) and the variance tanh h.
    const double middle =
        (low + high) / (2 * std::cosh(half)) + std::sqrt(std::tanh(half)) * deviate(noise, pair, level, place);
    const bool is_later = part >= 0.5;
    (is_later ? low : high) = middle;
    place = 2 * place + (is_later ? 1 : 0);
    if (is_later) part -= 0.5;
  }
  const double rest = 1 - part;
  const double normal =
      (rest * low + part * high) / std::sqrt(rest * rest + part * part + 2 * part * rest * std::exp(-2 * half));
  const double variance = std::log1p(noise.spread * noise.spread);
  return std::exp(std::sqrt(variance) * normal - 0.5 * variance);
}

}  // namespace

double direction_factor(const WallDirection& direction, const std::array<Vec3, 4>& face) {
  const Vec3 normal = facet_area_vector(face).normalized();
  const Vec3 up = (face[2] + face[3] - face[0] - face[1]).normalized();  // from base to apex
  const Vec3 axis = direction.across ? Vec3::UnitY() : Vec3::UnitX();
  const Vec3 in_surface = axis - axis.dot(up) * up;
  const double squared = in_surface.squaredNorm();
  const double cosine = squared > least_in_surface ? normal.dot(in_surface) * normal.dot(in_surface) / squared : 0.5;
  return direction.weakest + (direction.strongest - direction.weakest) * cosine;
}

// With the axis e, the area vector N and U from base to apex, p = e - (e.U) U/|U|^2 is the axis in the surface, and
// cos^2 a = (N.p)^2/(|N|^2 |p|^2).
std::array<Vec3, 4> direction_gradient(const WallDirection& direction, const std::array<Vec3, 4>& face) {
  const Vec3 one = face[2] - face[0], other = face[3] - face[1], N = facet_area_vector(face);
  const Vec3 U = face[2] + face[3] - face[0] - face[1], e = direction.across ? Vec3::UnitY() : Vec3::UnitX();
  const double m = e.dot(U) / U.squaredNorm();
  const Vec3 p = e - m * U;
  const double squared = p.squaredNorm(), part = N.dot(p), size = N.squaredNorm();
  std::array<Vec3, 4> gradient = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  if (squared <= least_in_surface) return gradient;
  const double cosine = part * part / (size * squared), range = direction.strongest - direction.weakest;
  const Vec3 by_N = 2 * range * (part / (size * squared) * p - cosine / size * N);
  // d(N.p) = -m N.dU - N.U dm and d|p|^2 = -2 m p.dU - 2 U.p dm, where U.p = 0, and dm = (p - m U).dU/|U|^2.
  const Vec3 by_U =
      2 * range *
      (part / (size * squared) * (-m * N - N.dot(U) / U.squaredNorm() * (p - m * U)) + cosine / squared * m * p);
  const Vec3 by_one = 0.5 * other.cross(by_N), by_other = 0.5 * by_N.cross(one);
  gradient[0] = -by_one - by_U;
  gradient[1] = -by_other - by_U;
  gradient[2] = by_one + by_U;
  gradient[3] = by_other + by_U;
  return gradient;
}

double noise_factor(const WallNoise& noise, std::uint64_t pair, double time_s) {
  return factor_between(noise, pair, values_about(noise, pair, knot_before(noise, time_s)), time_s);
}

void NoiseOfPairs::go_to(double time_s, std::span<const std::uint64_t> pairs) {
  const std::int64_t knot = knot_before(noise_, time_s);
  if (knot != knot_) values_.clear();
  knot_ = knot;
  for (const std::uint64_t pair : pairs)
    if (const auto [value, is_new] = values_.try_emplace(pair); is_new)
      value->second = values_about(noise_, pair, knot);
  time_s_ = time_s;
}

double NoiseOfPairs::factor(std::uint64_t pair) const {
  return factor_between(noise_, pair, values_.at(pair), time_s_);
}

std::vector<std::uint64_t> pair_numbers(const Tissue& tissue, std::span<const Face> faces) {
  std::vector<std::uint64_t> numbers;
  for (const Face& face : faces) {
    const auto id = [&](CellId cell) { return tissue.cells[cell.index()].lineage.id; };
    const int own = id(face.cell), other = face.beyond ? id(*face.beyond) : -1;
    numbers.push_back(pair_number(std::min(own, other), std::max(own, other)));
  }
  return numbers;
}

}  // namespace plica
