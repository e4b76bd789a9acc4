#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/place.hpp"
#include "tissue/shapes/solid_harmonics.hpp"
#include "tissue/shapes/star_surface.hpp"

namespace plica {
namespace {

constexpr std::size_t least_points = 12;
constexpr std::size_t points_per_coefficient = 3;
constexpr double widest_hole_cosine = 0.2;  // about 78 degrees from a direction to the next point: no surface around
constexpr double largest_share = 0.1;       // of a point's radius, that it may be from the surface

void check_points(const Vectors& points) {
  if (points.size() < least_points)
    throw MeshError(fmt::format("{} points; a closed surface requires at least {}", points.size(), least_points));
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite())
      throw MeshError(fmt::format("row {} is not a point; give three finite lengths in um", i));
    if (points[i].norm() < 1e-9)
      throw MeshError(fmt::format("row {} is at the origin; points must surround the origin", i));
  }
  // Every direction needs a point somewhere near it.
  Vectors directions;
  directions.reserve(points.size());
  for (const Vec3& point : points) directions.push_back(point.normalized());
  for (const Vec3& direction : even_directions(200)) {
    double nearest = -1;
    for (const Vec3& other : directions) nearest = std::max(nearest, direction.dot(other));
    if (nearest < widest_hole_cosine)
      throw MeshError(
          fmt::format("no point lies toward ({:.2f}, {:.2f}, {:.2f}), seen from the origin; points must "
                      "surround the origin: shift them; an open sheet is made by Python's plica.polygons_of_centres",
                      direction.x(), direction.y(), direction.z()));
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
  const std::size_t count = harmonic_count(degree);
  const std::vector<double> norms = harmonic_norms(degree);
  Eigen::MatrixXd rows(points.size(), count);
  Eigen::VectorXd radii(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vec3 u = (frame.axes.transpose() * points[i]).cwiseQuotient(frame.half_axes);
    const double length = u.norm();
    HarmonicValues values;
    evaluate_harmonics(u / length, degree, values);
    // A change of the scaled radius moves the surface by this many um along its normal, about.
    const double weight = 1 / (u / length).cwiseQuotient(frame.half_axes).norm();
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < count; ++k) rows(row, static_cast<Eigen::Index>(k)) = weight * norms[k] * values[k];
    radii[row] = weight * length;
  }
  const Eigen::VectorXd solution = rows.householderQr().solve(radii);
  return {solution.begin(), solution.end()};
}

}  // namespace

StarFit fit_star_surface(const Vectors& points, int degree) {
  check_points(points);
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
    throw MeshError(fmt::format(
        "row {} at {} is {:.2g} um from the smooth closed surface through the points, and {} of "
        "{} rows are further than a tenth of their radius; give points on one surface "
        "that every ray from the origin meets once",
        farthest, place_text(points[farthest]), farthest_share * points[farthest].norm(), far_count, points.size()));
  fit.rms_um = std::sqrt(squares / static_cast<double>(points.size()));
  return fit;
}

}  // namespace plica
