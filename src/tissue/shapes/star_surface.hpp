// A smooth closed surface around the origin that every ray from there meets once: the shape of a measured embryo.
//
// Lengths are first divided by three half-axes along directions of the surface's own, which turns an elongated egg into
// nearly a unit sphere. There the radius is a polynomial in the direction, as a sum of harmonics (solid_harmonics.hpp).
// Scaled first, degree 6 follows a measured embryo to 0.3 um; unscaled, the poles of an egg take twice the degree.
#pragma once

#include <array>
#include <vector>

#include "core/vector.hpp"

namespace plica {

/// How a surface lies and bends at one of its points.
struct SurfaceBend {
  Vec3 normal;                   // unit, outward
  std::array<double, 2> radii;   // um; principal radii of curvature, the smaller first where both are positive.
                                 // Positive: the surface bends inward, as a ball's does
  std::array<Vec3, 2> tangents;  // unit, the directions of these radii
};

/// The place of a surface nearest to a point.
struct ClosestOnSurface {
  Vec3 point;                 // um
  Vec3 normal;                // unit, outward
  double signed_distance_um;  // of what was asked for: negative inside
  SurfaceBend bend;           // there
};

class StarSurface {
 public:
  /// The surface x = axes * diag(half_axes) * u with |u| = the sum of harmonics at u / |u|, each harmonic scaled to a
  /// mean square of 1. `axes` is a rotation. (degree + 1)^2 coefficients. MeshError where the radius is not positive.
  StarSurface(const Mat3& axes, const Vec3& half_axes_um, const std::vector<double>& coefficients);

  [[nodiscard]] int degree() const { return degree_; }
  [[nodiscard]] const Vec3& half_axes() const { return half_axes_; }  // um; of the scaling

  /// x / half-axes along the axes, made a unit vector: where the ray through the point meets the unit sphere.
  [[nodiscard]] Vec3 scaled_direction(const Vec3& point) const { return (to_scaled_ * point).normalized(); }

  /// The place whose scaled direction is this unit vector.
  [[nodiscard]] Vec3 in_direction(const Vec3& scaled) const { return to_real_ * (scaled_radius(scaled) * scaled); }

  /// Area of the surface over that of the unit sphere of scaled directions there, um^2.
  [[nodiscard]] double area_over(const Vec3& scaled) const;

  /// Where the ray from the origin through the point meets the surface. The point may not be the origin.
  [[nodiscard]] Vec3 along_ray(const Vec3& point) const;

  /// On the surface, next to a point that is near it already: to first order along the normal. Quick.
  [[nodiscard]] Vec3 put_on(const Vec3& point) const;

  /// The nearest place, to 1e-9 of the size, from outside and from inside; where several are nearest, one of them.
  [[nodiscard]] ClosestOnSurface closest(const Vec3& point) const;

  /// The same for a point that lies next to the surface, within a fifth of the least radius of curvature. Quick.
  [[nodiscard]] ClosestOnSurface closest_by_ray(const Vec3& point) const;

  /// Normal and bend where the ray through the point meets the surface.
  [[nodiscard]] SurfaceBend bend(const Vec3& point) const;

  /// The least positive principal radius of curvature, of some 500 places all over the surface; um.
  [[nodiscard]] double least_radius() const { return least_radius_; }

  /// The volume that it encloses, um^3, and its area, um^2: by a quadrature good to about 1e-4.
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
  std::array<std::vector<double>, 3> gradient_;  // of its derivatives along x, y, z
  std::array<std::vector<double>, 6> hessian_;   // xx, yy, zz, xy, xz, yz
  Vectors sample_directions_, samples_;          // all over the surface: where to look for the nearest place
  double least_radius_ = 0;
};

/// A surface through points, and how well it fits.
struct StarFit {
  StarSurface surface;
  double rms_um;      // of the points' distances from the surface
  double largest_um;  // the largest of them
  std::size_t largest_row;
};

/// The surface that is nearest to the points in the sense of least squares (of distances, to first order). The degree
/// is lowered where there are fewer than three points a coefficient. MeshError, which names rows (from 0), when there
/// are fewer than 12 points, one is not finite or at the origin, they lie on one side of the origin, or one is further
/// than a tenth of its radius from the surface.
StarFit fit_star_surface(const Vectors& points, int degree = 6);

/// Directions spread evenly over the unit sphere: a spiral lattice.
Vectors even_directions(std::size_t count);

}  // namespace plica
