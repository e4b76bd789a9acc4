// The smooth closed surface that an embryo's apices lie on at rest, or that its shell has: a capsule, or a surface that
// rays from the origin meet once. It does not depend on the mesh.
#pragma once

#include <memory>
#include <optional>

#include "core/vector.hpp"

namespace plica {

class StarSurface;

/// A capsule (a cylinder between two half balls, axis on x), or a ball when half_axis is 0: the shape of built embryos.
struct Capsule {
  double half_axis_um = 0;  // half the length of the cylinder
  double radius_um = 0;
};

class OuterShape {
 public:
  OuterShape(const Capsule& capsule) : capsule_(capsule) {}  // NOLINT(google-explicit-constructor): it is one
  explicit OuterShape(std::shared_ptr<const StarSurface> surface) : surface_(std::move(surface)) {}

  /// The parallel surface, farther out by so much.
  [[nodiscard]] OuterShape moved_out(double by_um) const;

  /// The way from a point inside to the surface (negative outside, um), its gradient (of length 1) and Hessian (1/um).
  /// Inside by more than a fifth of the least radius of curvature, of a surface that is no capsule to first order only.
  struct Gap {
    double value;
    Vec3 inward;
    Mat3 hessian;
  };
  [[nodiscard]] Gap gap(const Vec3& point) const;

  /// How far a point on y = 0 lies inside, against a direction `outward` in that plane: the way to where the line along
  /// it leaves the surface, um; negative outside. Where the line misses the surface, to its height at the end.
  [[nodiscard]] double depth(const Vec3& point, const Vec3& outward) const;

  /// What it encloses, um^3.
  [[nodiscard]] double volume() const;

  /// Where it is one.
  [[nodiscard]] const std::optional<Capsule>& capsule() const { return capsule_; }

 private:
  std::optional<Capsule> capsule_;              // or
  std::shared_ptr<const StarSurface> surface_;  // moved out by
  double out_um_ = 0;
};

}  // namespace plica
