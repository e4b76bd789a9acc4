#include "tissue/shapes/egg_surface.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/solid_harmonics.hpp"

namespace plica {
namespace {

constexpr int egg_degree = 5;

double even_term(const Vec3& d) { return d.x() * d.x() * (1 - d.x() * d.x()); }
double odd_term(const Vec3& d) { return d.z() * d.x() * d.x() * (1 - d.x() * d.x() / 2); }

// The outline in the plane y = 0 of the scaled egg.
struct Outline {
  double even, odd;

  // At an angle from +x; towards the back where it is positive.
  [[nodiscard]] Vec3 at(double angle) const {
    const Vec3 d(std::cos(angle), 0, std::sin(angle));
    return (1 + even * even_term(d) + odd * odd_term(d)) * d;
  }

  [[nodiscard]] double half_length() const {
    // x has one maximum near the pole: golden section.
    double low = -1, high = 1;
    for (int i = 0; i < 80; ++i) {
      const double third = (high - low) * 0.382;
      if (at(low + third).x() < at(high - third).x())
        low += third;
      else
        high -= third;
    }
    return at(low).x();
  }

  // Sag of the dorsal (side 1) or ventral side (-1), relative to the half height.
  [[nodiscard]] double sag(int side) const {
    const double x = 0.6 * half_length();
    double low = 0, high = std::numbers::pi / 2;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (at(side * middle).x() > x ? low : high) = middle;
    }
    return 1 - std::abs(at(side * low).z());
  }
};

// Newton's method by differences: the terms that give these sags (as shares of the half height).
Outline outline_with(double belly_sag, double back_sag) {
  Outline outline{0, 0};
  const Eigen::Vector2d wanted(belly_sag, back_sag);
  const auto sags = [](const Outline& o) { return Eigen::Vector2d(o.sag(-1), o.sag(1)); };
  for (int iteration = 0; iteration < 50; ++iteration) {
    const Eigen::Vector2d now = sags(outline);
    if ((now - wanted).norm() < 1e-10) break;
    constexpr double h = 1e-5;
    Eigen::Matrix2d slopes;
    slopes.col(0) = (sags({outline.even + h, outline.odd}) - now) / h;
    slopes.col(1) = (sags({outline.even, outline.odd + h}) - now) / h;
    const Eigen::Vector2d step = slopes.fullPivLu().solve(wanted - now);
    const double share = std::min(1.0, 0.1 / step.norm());
    outline.even += share * step[0];
    outline.odd += share * step[1];
  }
  // Beyond a half the pole or the middle of the back is hollow; that is no egg.
  const bool found = (sags(outline) - wanted).norm() < 1e-8;
  if (!found || outline.even > 0.48 || outline.even + std::abs(outline.odd) > 0.5)
    throw MeshError(
        fmt::format("no egg shape has sags of {:.3g} and {:.3g} % of its height; an ellipsoid has 10 %, a "
                    "measured embryo 9.4 and 3.9 %",
                    50 * belly_sag, 50 * back_sag));
  return outline;
}

}  // namespace

StarSurface egg_surface(const EggShape& shape) {
  for (const double length : {shape.length_um, shape.width_um, shape.height_um})
    if (!(length > 0) || !std::isfinite(length))
      throw MeshError(fmt::format("an egg of {:.4g} x {:.4g} x {:.4g} um; lengths must be positive", shape.length_um,
                                  shape.width_um, shape.height_um));
  Vec3 half_axes = 0.5 * Vec3(shape.length_um, shape.width_um, shape.height_um);
  Outline outline{0, 0};
  if (shape.belly_sag_um || shape.back_sag_um) {
    const double usual = 0.2 * half_axes.z();
    outline = outline_with(shape.belly_sag_um.value_or(usual) / half_axes.z(),
                           shape.back_sag_um.value_or(usual) / half_axes.z());
    half_axes.x() /= outline.half_length();
  }
  // The terms are polynomials of degree 5, so a fit to enough directions finds their harmonics to rounding.
  const Vectors directions = even_directions(400);
  const std::size_t count = harmonic_count(egg_degree);
  const std::vector<double> norms = harmonic_norms(egg_degree);
  Eigen::MatrixXd rows(directions.size(), count);
  Eigen::VectorXd radii(directions.size());
  for (std::size_t i = 0; i < directions.size(); ++i) {
    HarmonicValues values;
    evaluate_harmonics(directions[i], egg_degree, values);
    const auto row = static_cast<Eigen::Index>(i);
    for (std::size_t k = 0; k < count; ++k) rows(row, static_cast<Eigen::Index>(k)) = norms[k] * values[k];
    radii[row] = 1 + outline.even * even_term(directions[i]) + outline.odd * odd_term(directions[i]);
  }
  const Eigen::VectorXd solution = rows.householderQr().solve(radii);
  return {Mat3::Identity(), half_axes, {solution.begin(), solution.end()}};
}

}  // namespace plica
