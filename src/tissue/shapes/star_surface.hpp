// Smooth closed surface around the origin that every ray from it meets once: the shape of a measured embryo.
//
// Lengths are first divided by three half-axes along the principal directions of the surface, which turns an elongated
// egg into nearly a unit sphere. There the radius is a polynomial in the direction, as a sum of harmonics
// (below). Scaled first, degree 6 follows a measured embryo to 0.3 um; unscaled, the poles of an egg take
// twice the degree.
#pragma once

#include <array>
#include <vector>

#include "core/vector.hpp"

namespace plica {

// Real solid harmonics: polynomials in x, y, z that form, on the unit sphere, an orthogonal basis of all polynomials up
// to a degree. Their derivatives are again solid harmonics, so a sum of them is differentiated by its coefficients.
//
// With R_lm = r^l P_lm(cos theta) exp(i m phi) / (l + m)!, place l^2 + l + m holds Re R_lm for m >= 0, Im R_l|m| for
// m < 0. (Monomials span the same space, but a fit by them loses digits with every degree.)

inline constexpr int largest_harmonic_degree = 16;

constexpr std::size_t harmonic_count(int degree) {
  return static_cast<std::size_t>(degree + 1) * static_cast<std::size_t>(degree + 1);
}

using HarmonicValues = std::array<double, harmonic_count(largest_harmonic_degree)>;

/// Evaluate the harmonics up to `degree` at a unit vector; later places are not set.
void evaluate_harmonics(const Vec3& direction, int degree, HarmonicValues& values);

/// Return factors that give each harmonic a mean square of 1 over the sphere.
std::vector<double> harmonic_norms(int degree);

/// Return the coefficients of harmonics, each scaled to a mean square of 1, whose sums in some directions (unit
/// vectors) are nearest to the radii there, by weighted least squares.
std::vector<double> fit_harmonics(const Vectors& directions, const std::vector<double>& radii,
                                  const std::vector<double>& weights, int degree);

/// Return the coefficients of the derivative along x, y or z (axis 0, 1, 2); the number is unchanged, the highest
/// degree is 0.
std::vector<double> harmonic_derivative(const std::vector<double>& coefficients, int degree, int axis);

/// Normal and curvature of a surface at a point.
struct SurfaceBend {
  Vec3 normal;                   // unit, outward
  std::array<double, 2> radii;   // um; principal radii of curvature, the smaller first where both are positive.
                                 // Positive: the surface bends inward, as a ball's does
  std::array<Vec3, 2> tangents;  // unit, the directions of these radii
};

/// Place of a surface nearest to a point.
struct ClosestOnSurface {
  Vec3 point;                 // um
  Vec3 normal;                // unit, outward
  double signed_distance_um;  // distance of the given point: negative inside
  SurfaceBend bend;           // there
};

class StarSurface {
 public:
  /// Surface x = axes * diag(half_axes) * u with |u| = the sum of harmonics at u / |u|, each harmonic scaled to a mean
  /// square of 1. `axes` is a rotation. (degree + 1)^2 coefficients. MeshError if the radius is not positive.
  StarSurface(const Mat3& axes, const Vec3& half_axes_um, const std::vector<double>& coefficients);

  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] const Vec3& half_axes() const { return half_axes_; }  // um; of the scaling

  /// Return x / half-axes along the axes as a unit vector: the intersection of the ray through the point with the unit
  /// sphere.
  [[nodiscard]] Vec3 scaled_direction(const Vec3& point) const { return (to_scaled_ * point).normalized(); }

  /// Return the place with this scaled direction (unit vector).
  [[nodiscard]] Vec3 in_direction(const Vec3& scaled) const { return to_real_ * (scaled_radius(scaled) * scaled); }

  /// Return the area of the surface / area of the unit sphere of scaled directions there, um^2.
  [[nodiscard]] double area_over(const Vec3& scaled) const;

  /// Return the intersection with the ray from the origin through the point, which must not be the origin.
  [[nodiscard]] Vec3 along_ray(const Vec3& point) const;

  /// Project a point near the surface onto it, to first order along the normal. Fast.
  [[nodiscard]] Vec3 put_on(const Vec3& point) const;

  /// Return the nearest place, to 1e-9 of the size, from outside or inside; one of them, if several are nearest.
  [[nodiscard]] ClosestOnSurface closest(const Vec3& point) const;

  /// Return the nearest place for a point within a fifth of the least radius of curvature from the surface. Fast.
  [[nodiscard]] ClosestOnSurface closest_by_ray(const Vec3& point) const;

  /// Return normal and curvature at the intersection with the ray through the point.
  [[nodiscard]] SurfaceBend bend(const Vec3& point) const;

  /// Return the least positive principal radius of curvature over about 500 places of the surface, um.
  [[nodiscard]] double least_radius() const { return least_radius_; }

  /// Return the enclosed volume, um^3, and the area, um^2, by a quadrature accurate to about 1e-4.
  [[nodiscard]] double volume() const;
  [[nodiscard]] double area() const;

 private:
  struct Chart;  // position and derivatives over two coordinates of the tangent plane of the unit sphere

  [[nodiscard]] double scaled_radius(const Vec3& direction) const;
  [[nodiscard]] Chart chart(const Vec3& direction) const;
  [[nodiscard]] Chart nearest(const Vec3& point, Vec3 direction) const;

  Vec3 half_axes_;
  Mat3 to_real_, to_scaled_;
  int degree_;
  std::vector<double> radius_;                   // coefficients of unscaled harmonics
  std::vector<std::array<double, 3>> gradient_;  // derivatives along x, y, z
  std::vector<std::array<double, 6>> hessian_;   // xx, yy, zz, xy, xz, yz
  Vectors sample_directions_, samples_;          // start points of the search for the nearest place
  double least_radius_ = 0;
};

/// Surface fitted to points, with its residuals.
struct StarFit {
  StarSurface surface;
  double rms_um;      // root mean square distance of the points
  double largest_um;  // the largest of them
  std::size_t largest_row;
};

/// Fit a surface to points by least squares (of distances, to first order). The degree is lowered if there are fewer
/// than three points per coefficient. MeshError, naming rows (from 0), if there are fewer than 12 points, one is not
/// finite or at the origin, they lie on one side of the origin, or one is further than a tenth of its radius from the
/// surface.
StarFit fit_star_surface(const Vectors& points, int degree = 6);

/// Return directions distributed evenly over the unit sphere: a spiral lattice.
Vectors even_directions(std::size_t count);

}  // namespace plica
