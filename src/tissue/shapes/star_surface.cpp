#include "tissue/shapes/star_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

#include "tissue/mesh_input.hpp"

namespace plica {
namespace {

constexpr int place(int l, int m) { return l * l + l + m; }

constexpr std::size_t sample_count = 500;

// Two unit vectors at right angles to a unit vector and each other; e1 x e2 = direction.
std::array<Vec3, 2> tangents_of(const Vec3& direction) {
  int least = 0;
  direction.cwiseAbs().minCoeff(&least);
  const Vec3 first = direction.cross(Vec3::Unit(least)).normalized();
  return {first, direction.cross(first)};
}

// 1/(l^2 - m^2), for |m| < l.
constexpr HarmonicValues recurrence_scales() {
  HarmonicValues scales{};
  for (int l = 1; l <= largest_harmonic_degree; ++l)
    for (int m = 1 - l; m < l; ++m) scales[place(l, m)] = 1.0 / (l * l - m * m);
  return scales;
}

double sum_of(const std::vector<double>& coefficients, const HarmonicValues& values, int degree) {
  double sum = 0;
  for (std::size_t i = 0; i < harmonic_count(degree); ++i) sum += coefficients[i] * values[i];
  return sum;
}

// The same for several functions at once; coefficients: by harmonic, then by function. Without any if degree < 0.
template <std::size_t count>
std::array<double, count> sums_of(const std::vector<std::array<double, count>>& coefficients,
                                  const HarmonicValues& values, int degree) {
  std::array<double, count> sums{};
  for (std::size_t i = 0; degree >= 0 && i < harmonic_count(degree); ++i)
    for (std::size_t k = 0; k < count; ++k) sums[k] += coefficients[i][k] * values[i];
  return sums;
}

template <std::size_t count>
std::vector<std::array<double, count>> by_harmonic(const std::array<std::vector<double>, count>& by_function) {
  std::vector<std::array<double, count>> result(by_function.front().size());
  for (std::size_t i = 0; i < result.size(); ++i)
    for (std::size_t k = 0; k < count; ++k) result[i][k] = by_function[k][i];
  return result;
}

// The least k for which det(hessian - k metric) is 0: a quadratic.
double least_eigenvalue(const Eigen::Matrix2d& hessian, const Eigen::Matrix2d& metric) {
  const double det = metric.determinant();
  const double half_sum =
      0.5 * (hessian(0, 0) * metric(1, 1) + hessian(1, 1) * metric(0, 0) - 2 * hessian(0, 1) * metric(0, 1)) / det;
  return half_sum - std::sqrt(std::max(0.0, half_sum * half_sum - hessian.determinant() / det));
}

constexpr std::size_t fewest_points = 12;
constexpr std::size_t points_per_coefficient = 3;
constexpr double widest_gap_cosine = 0.2;  // about 78 degrees from a direction to the next point: no surface around
constexpr double largest_share = 0.1;      // of a point's radius, that it may be from the surface

void check_surrounding(const Vectors& points) {
  if (points.size() < fewest_points)
    throw MeshError("{} points; a closed surface requires at least {}", points.size(), fewest_points);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) throw MeshError("row {} is not a point; give three finite lengths in um", i);
    if (points[i].norm() < 1e-9) throw MeshError("row {} is at the origin; points must surround the origin", i);
  }
  // Every direction needs a point somewhere near it.
  Vectors directions;
  directions.reserve(points.size());
  for (const Vec3& point : points) directions.push_back(point.normalized());
  for (const Vec3& direction : even_directions(200)) {
    double nearest = -1;
    for (const Vec3& other : directions) nearest = std::max(nearest, direction.dot(other));
    if (nearest < widest_gap_cosine)
      throw MeshError(
          "no point lies toward ({:.2f}, {:.2f}, {:.2f}), seen from the origin; points must surround the origin: shift "
          "them; an open sheet is made by Python's plica.polygons_of_centres",
          direction.x(), direction.y(), direction.z());
  }
}

struct Frame {
  Mat3 axes;
  Vec3 half_axes;
};

// The ellipsoid x . A x = 1 about the origin, of least squares.
Frame frame_of(const Vectors& points) {
  double scale = 0;
  for (const Vec3& point : points) scale = std::max(scale, point.norm());
  Eigen::MatrixXd rows(points.size(), 6);
  Mat3 moments = Mat3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 p = points[i] / scale;
    rows.row(static_cast<Eigen::Index>(i)) << p.x() * p.x(), p.y() * p.y(), p.z() * p.z(), 2 * p.x() * p.y(),
        2 * p.x() * p.z(), 2 * p.y() * p.z();
    moments += p * p.transpose() / static_cast<double>(points.size());
  }
  const Eigen::VectorXd a =
      rows.colPivHouseholderQr().solve(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(points.size())));
  Mat3 A;
  A << a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2];
  Eigen::SelfAdjointEigenSolver<Mat3> solver(A);
  Vec3 half_axes = solver.eigenvalues().cwiseMax(0).cwiseInverse().cwiseSqrt();
  // No ellipsoid: the points' second moments serve as well, the harmonics follow what is left.
  if (!half_axes.allFinite() || half_axes.maxCoeff() > 2) {
    solver.compute(moments);
    half_axes = (3 * solver.eigenvalues()).cwiseMax(0).cwiseSqrt();
  }
  if (half_axes.minCoeff() < 1e-3)
    throw MeshError(
        "the points lie in a plane; give points on a closed surface around the origin; an open sheet is made by "
        "Python's plica.polygons_of_centres");
  Frame frame{solver.eigenvectors(), scale * half_axes};
  if (frame.axes.determinant() < 0) frame.axes.col(2) *= -1;
  return frame;
}

std::vector<double> fit_coefficients(const Vectors& points, const Frame& frame, int degree) {
  Vectors directions;
  std::vector<double> radii, weights;
  for (const Vec3& point : points) {
    const Vec3 u = (frame.axes.transpose() * point).cwiseQuotient(frame.half_axes);
    radii.push_back(u.norm());
    directions.emplace_back(u / radii.back());
    // A change of the scaled radius moves the surface by this many um along its normal, about.
    weights.push_back(1 / directions.back().cwiseQuotient(frame.half_axes).norm());
  }
  return fit_harmonics(directions, radii, weights, degree);
}

}  // namespace

void evaluate_harmonics(const Vec3& direction, int degree, HarmonicValues& values) {
  static constexpr HarmonicValues scales = recurrence_scales();
  const double x = direction.x(), y = direction.y(), z = direction.z();
  double real = 1, imaginary = 0;  // R_ll
  values[0] = 1;
  for (int l = 1; l <= degree; ++l) {
    const double next = (x * real - y * imaginary) / (2 * l);
    imaginary = (x * imaginary + y * real) / (2 * l);
    real = next;
    // (l^2 - m^2) R_lm = (2l - 1) z R_(l-1)m - R_(l-2)m on the unit sphere, the last 0 where |m| > l - 2.
    const double z_l = (2 * l - 1) * z;
    double* row = &values[place(l, 0)];
    const double* scale = &scales[place(l, 0)];
    const double* last = &values[place(l - 1, 0)];
    row[-l] = imaginary;
    row[l] = real;
    for (const int m : {1 - l, l - 1}) row[m] = scale[m] * (z_l * last[m]);
    if (l < 2) continue;
    const double* before = &values[place(l - 2, 0)];
    for (int m = 2 - l; m <= l - 2; ++m) row[m] = scale[m] * (z_l * last[m] - before[m]);
  }
}

std::vector<double> harmonic_norms(int degree) {
  std::vector<double> norms(harmonic_count(degree));
  for (int l = 0; l <= degree; ++l)
    for (int m = 0; m <= l; ++m) {
      const double product = std::exp(std::lgamma(l + m + 1) + std::lgamma(l - m + 1));
      norms[place(l, m)] = norms[place(l, -m)] = std::sqrt((2 * l + 1) * product * (m > 0 ? 2 : 1));
    }
  return norms;
}

std::vector<double> fit_harmonics(const Vectors& directions, const std::vector<double>& radii,
                                  const std::vector<double>& weights, int degree) {
  const std::size_t count = harmonic_count(degree);
  const std::vector<double> norms = harmonic_norms(degree);
  Eigen::MatrixXd rows(directions.size(), count);
  Eigen::VectorXd right(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    HarmonicValues values;
    evaluate_harmonics(directions[i], degree, values);
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < count; ++k) rows(row, static_cast<Eigen::Index>(k)) = weights[i] * norms[k] * values[k];
    right[row] = weights[i] * radii[i];
  }
  const Eigen::VectorXd solution = rows.householderQr().solve(right);
  return {solution.begin(), solution.end()};
}

std::vector<double> harmonic_derivative(const std::vector<double>& coefficients, int degree, int axis) {
  std::vector<double> derivative(coefficients.size(), 0.0);
  // Adds `factor` times Re or Im R_(l-1)m; places outside of the triangle |m| <= l - 1 are 0, and so is Im R_l0.
  const auto add = [&](int l, int m, bool real, double factor) {
    if (m > l - 1 || (m == 0 && !real)) return;
    derivative[place(l - 1, real ? m : -m)] += factor;
  };
  for (int l = 1; l <= degree; ++l)
    for (int m = 0; m <= l; ++m) {
      const double real = coefficients[place(l, m)], imaginary = m > 0 ? coefficients[place(l, -m)] : 0;
      if (axis == 2) {
        add(l, m, true, real);
        add(l, m, false, imaginary);
      } else if (m == 0) {
        add(l, 1, axis == 0, -real);
      } else if (axis == 0) {
        add(l, m - 1, true, real / 2);
        add(l, m + 1, true, -real / 2);
        add(l, m - 1, false, imaginary / 2);
        add(l, m + 1, false, -imaginary / 2);
      } else {
        add(l, m - 1, false, -real / 2);
        add(l, m + 1, false, -real / 2);
        add(l, m - 1, true, imaginary / 2);
        add(l, m + 1, true, imaginary / 2);
      }
    }
  return derivative;
}

// X(a, b) = S rho(n) n with n = d + a e1 + b e2, made a unit vector, at a = b = 0.
struct StarSurface::Chart {
  std::array<Vec3, 2> tangents;  // e1, e2
  Vec3 X;
  std::array<Vec3, 2> first;
  std::array<Vec3, 3> second;  // aa, ab, bb

  [[nodiscard]] Vec3 normal() const { return first[0].cross(first[1]).normalized(); }
  [[nodiscard]] Eigen::Matrix2d metric() const {
    return symmetric(first[0].squaredNorm(), first[0].dot(first[1]), first[1].squaredNorm());
  }
  /// Component of each second derivative along a vector.
  [[nodiscard]] Eigen::Matrix2d second_along(const Vec3& way) const {
    return symmetric(way.dot(second[0]), way.dot(second[1]), way.dot(second[2]));
  }
  [[nodiscard]] SurfaceBend bend() const;
  [[nodiscard]] ClosestOnSurface seen_from(const Vec3& point) const;

 private:
  static Eigen::Matrix2d symmetric(double aa, double ab, double bb) {
    Eigen::Matrix2d matrix;
    matrix << aa, ab, ab, bb;
    return matrix;
  }
};

StarSurface::StarSurface(const Mat3& axes, const Vec3& half_axes_um, const std::vector<double>& coefficients)
    : half_axes_(half_axes_um),
      to_real_(axes * half_axes_um.asDiagonal()),
      to_scaled_(half_axes_um.cwiseInverse().asDiagonal() * axes.transpose()),
      degree_(static_cast<int>(std::lround(std::sqrt(static_cast<double>(coefficients.size())))) - 1),
      radius_(coefficients) {
  const std::vector<double> norms = harmonic_norms(degree_);
  for (std::size_t i = 0; i < radius_.size(); ++i) radius_[i] *= norms[i];
  std::array<std::vector<double>, 3> gradient;
  for (int axis = 0; axis < 3; ++axis) gradient[axis] = harmonic_derivative(radius_, degree_, axis);
  constexpr std::array<std::array<int, 2>, 6> pairs = {{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {0, 2}, {1, 2}}};
  std::array<std::vector<double>, 6> hessian;
  for (int i = 0; i < 6; ++i) hessian[i] = harmonic_derivative(gradient[pairs[i][0]], degree_, pairs[i][1]);
  gradient_ = by_harmonic(gradient);
  hessian_ = by_harmonic(hessian);

  sample_directions_ = even_directions(sample_count);
  least_radius_ = std::numeric_limits<double>::infinity();
  for (const Vec3& direction : sample_directions_) {
    const double radius = scaled_radius(direction);
    samples_.push_back(to_real_ * (radius * direction));
    if (!(radius > 0))
      throw MeshError(
          "the surface passes through the origin in the direction ({:.3g}, {:.3g}, {:.3g}); move the surface so that "
          "the origin is well inside",
          samples_.back().x(), samples_.back().y(), samples_.back().z());
    for (const double bend_radius : bend(samples_.back()).radii)
      if (bend_radius > 0) least_radius_ = std::min(least_radius_, bend_radius);
  }
}

double StarSurface::scaled_radius(const Vec3& direction) const {
  HarmonicValues values;
  evaluate_harmonics(direction, degree_, values);
  return sum_of(radius_, values, degree_);
}

StarSurface::Chart StarSurface::chart(const Vec3& direction) const {
  HarmonicValues values;
  evaluate_harmonics(direction, degree_, values);
  const double rho = sum_of(radius_, values, degree_);
  const Vec3 gradient(sums_of(gradient_, values, degree_ - 1).data());
  const auto [xx, yy, zz, xy, xz, yz] = sums_of(hessian_, values, degree_ - 2);
  Mat3 hessian;
  hessian << xx, xy, xz, xy, yy, yz, xz, yz, zz;

  Chart c;
  c.tangents = tangents_of(direction);
  c.X = to_real_ * (rho * direction);
  const double slope = gradient.dot(direction);
  std::array<double, 2> rho_1{};
  for (int i = 0; i < 2; ++i) {
    rho_1[i] = gradient.dot(c.tangents[i]);
    c.first[i] = to_real_ * (rho_1[i] * direction + rho * c.tangents[i]);
  }
  for (int i = 0, place = 0; i < 2; ++i)
    for (int j = i; j < 2; ++j) {
      // n_ij = -delta_ij d, so rho_ij = e_i H e_j - delta_ij grad . d.
      const double delta = i == j ? 1 : 0;
      const double rho_2 = c.tangents[i].dot(hessian * c.tangents[j]) - delta * slope;
      c.second[place++] =
          to_real_ * ((rho_2 - delta * rho) * direction + rho_1[i] * c.tangents[j] + rho_1[j] * c.tangents[i]);
    }
  return c;
}

Vec3 StarSurface::along_ray(const Vec3& point) const { return in_direction(scaled_direction(point)); }

Vec3 StarSurface::put_on(const Vec3& point) const {
  Vec3 x = point;
  for (int step = 0; step < 2; ++step) {
    // One Newton step of the function |u| - rho(u / |u|) along its gradient.
    const Vec3 u = to_scaled_ * x;
    const double length = u.norm();
    const Vec3 d = u / length;
    HarmonicValues values;
    evaluate_harmonics(d, degree_, values);
    const Vec3 slope(sums_of(gradient_, values, degree_ - 1).data());
    const Vec3 gradient = to_scaled_.transpose() * (d - (slope - slope.dot(d) * d) / length);
    x -= (length - sum_of(radius_, values, degree_)) / gradient.squaredNorm() * gradient;
  }
  return along_ray(x);
}

StarSurface::Chart StarSurface::nearest(const Vec3& point, Vec3 direction) const {
  // Newton's method for the squared distance over the unit sphere, damped until the distance falls.
  double damping = 0;
  Chart c = chart(direction);
  double distance = (c.X - point).squaredNorm();
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Vec3 gap = c.X - point;
    const Eigen::Vector2d gradient(gap.dot(c.first[0]), gap.dot(c.first[1]));
    const Eigen::Matrix2d metric = c.metric(), hessian = metric + c.second_along(gap);
    // Far inside, the Hessian is indefinite: enough of the metric makes it definite.
    const double least = least_eigenvalue(hessian, metric);
    const double shift = damping + (least < 1e-3 ? 1e-3 - least + 0.1 * std::abs(least) : 0);
    const Eigen::Vector2d step = -(hessian + shift * metric).ldlt().solve(gradient);
    const double step_um = std::sqrt(step.dot(metric * step));
    const Vec3 next = (direction + step[0] * c.tangents[0] + step[1] * c.tangents[1]).normalized();
    const Chart next_chart = chart(next);
    const double next_distance = (next_chart.X - point).squaredNorm();
    // The next step would be as small as the square of this one.
    if (step_um < 1e-6 * half_axes_.minCoeff() && shift == 0) return next_chart;
    if (step_um < 1e-10 * half_axes_.minCoeff()) return next_distance <= distance ? next_chart : c;
    if (next_distance <= distance * (1 + 1e-14)) {
      direction = next;
      c = next_chart;
      distance = next_distance;
      damping = damping > 0.01 ? damping / 10 : 0;
    } else {
      damping = std::max(0.1, 4 * damping);
    }
  }
  return c;
}

ClosestOnSurface StarSurface::closest(const Vec3& point) const {
  // Near the surface the ray's place is a good start, else a few samples that are near and apart from each other.
  std::vector<Vec3> starts;
  const bool at_origin = point.norm() < 1e-9 * half_axes_.minCoeff();
  if (!at_origin) starts.push_back(scaled_direction(point));
  if (at_origin || (along_ray(point) - point).norm() > 0.2 * least_radius_) {
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t i = 0; i < samples_.size(); ++i) near.emplace_back((samples_[i] - point).squaredNorm(), i);
    std::ranges::sort(near);
    const std::size_t before = starts.size();
    for (const auto& [squared_distance, i] : near) {
      if (starts.size() == before + 4) break;
      const Vec3& candidate = sample_directions_[i];
      if (std::ranges::all_of(std::span(starts).subspan(before),
                              [&](const Vec3& start) { return start.dot(candidate) < 0.95; }))
        starts.push_back(candidate);
    }
  }
  double best = std::numeric_limits<double>::infinity();
  Chart c;
  for (const Vec3& start : starts) {
    const Chart found = nearest(point, start);
    const double squared_distance = (found.X - point).squaredNorm();
    if (squared_distance >= best) continue;
    best = squared_distance;
    c = found;
  }
  return c.seen_from(point);
}

ClosestOnSurface StarSurface::closest_by_ray(const Vec3& point) const {
  return nearest(point, scaled_direction(point)).seen_from(point);
}

ClosestOnSurface StarSurface::Chart::seen_from(const Vec3& point) const {
  const SurfaceBend here = bend();
  return {X, here.normal, std::copysign((point - X).norm(), (point - X).dot(here.normal)), here};
}

SurfaceBend StarSurface::bend(const Vec3& point) const { return chart(scaled_direction(point)).bend(); }

SurfaceBend StarSurface::Chart::bend() const {
  SurfaceBend bend;
  bend.normal = normal();
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> solver(-second_along(bend.normal), metric());
  for (int i = 0; i < 2; ++i) {
    const int from = 1 - i;  // the larger curvature first
    bend.radii[i] = 1 / solver.eigenvalues()[from];
    bend.tangents[i] =
        (solver.eigenvectors()(0, from) * first[0] + solver.eigenvectors()(1, from) * first[1]).normalized();
  }
  return bend;
}

double StarSurface::volume() const {
  // det(S) times the volume of the scaled surface, the mean of rho^3 over directions times 4 pi / 3.
  const Vectors directions = even_directions(20'000);
  double sum = 0;
  for (const Vec3& direction : directions) sum += std::pow(scaled_radius(direction), 3);
  return 4 * std::numbers::pi / 3 * half_axes_.prod() * sum / static_cast<double>(directions.size());
}

double StarSurface::area_over(const Vec3& scaled) const {
  const Chart c = chart(scaled);
  return c.first[0].cross(c.first[1]).norm();
}

double StarSurface::area() const {
  const Vectors directions = even_directions(20'000);
  double sum = 0;
  for (const Vec3& direction : directions) sum += area_over(direction);
  return 4 * std::numbers::pi * sum / static_cast<double>(directions.size());
}

Vectors even_directions(std::size_t count) {
  Vectors directions;
  directions.reserve(count);
  const double golden_angle = std::numbers::pi * (3 - std::sqrt(5.0));
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * static_cast<double>(i) + 1) / static_cast<double>(count);
    const double r = std::sqrt(1 - z * z), angle = golden_angle * static_cast<double>(i);
    directions.emplace_back(r * std::cos(angle), r * std::sin(angle), z);
  }
  return directions;
}

StarFit fit_star_surface(const Vectors& points, int degree) {
  check_surrounding(points);
  degree = std::clamp(degree, 0, largest_harmonic_degree);
  while (degree > 0 && harmonic_count(degree) * points_per_coefficient > points.size()) --degree;
  const Frame frame = frame_of(points);
  StarFit fit{StarSurface(frame.axes, frame.half_axes, fit_coefficients(points, frame, degree)), 0, 0, 0};

  double squares = 0;
  std::size_t far_count = 0, farthest = 0;
  double farthest_share = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double distance = std::abs(fit.surface.closest(points[i]).signed_distance_um);
    squares += distance * distance;
    if (distance > fit.largest_um) {
      fit.largest_um = distance;
      fit.largest_row = i;
    }
    const double share = distance / points[i].norm();
    if (share > largest_share) ++far_count;
    if (share > farthest_share) {
      farthest_share = share;
      farthest = i;
    }
  }
  if (far_count > 0)
    throw MeshError(
        "row {} at {} is {:.2g} um from the smooth closed surface through the points, and {} of {} rows are further "
        "than a tenth of their radius; give points on one surface that every ray from the origin meets once",
        farthest, place_text(points[farthest]), farthest_share * points[farthest].norm(), far_count, points.size());
  fit.rms_um = std::sqrt(squares / static_cast<double>(points.size()));
  return fit;
}

}  // namespace plica
