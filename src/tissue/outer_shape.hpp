// Smooth closed surface of the apical side in the reference state, or of the vitelline membrane: a capsule, or a
// surface that rays from the origin meet once. Independent of the mesh.
#pragma once

#include <memory>
#include <optional>

#include "core/vector.hpp"

namespace plica {

class StarSurface;

/// Capsule: a cylinder between two half balls, axis on x; a ball if half_axis is 0. The shape of built embryos.
struct Capsule {
  double half_axis_um = 0;  // half the length of the cylinder
  double radius_um = 0;
};

class OuterShape {
 public:
  OuterShape(const Capsule& capsule) : capsule_(capsule) {}  // NOLINT(google-explicit-constructor): it is one
  explicit OuterShape(std::shared_ptr<const StarSurface> surface) : surface_(std::move(surface)) {}

  /// Return the parallel surface, offset outward.
  [[nodiscard]] OuterShape moved_out(double by_um) const;

  /// Gap of a point: distance inside from the surface (negative outside, um), its gradient (length 1) and Hessian
  /// (1/um). For surfaces other than capsules, only to first order more than a fifth of the least radius of curvature
  /// inside.
  struct Gap {
    double value;
    Vec3 inward;
    Mat3 hessian;
  };
  [[nodiscard]] Gap gap(const Vec3& point) const;

  /// Return the depth of a point on y = 0, against a direction `outward` in that plane: distance to where the line
  /// along it leaves the surface, um; negative outside. If the line misses the surface, up to its height at the end.
  [[nodiscard]] double depth(const Vec3& point, const Vec3& outward) const;

  /// Return the enclosed volume, um^3.
  [[nodiscard]] double volume() const;

  [[nodiscard]] const std::optional<Capsule>& capsule() const { return capsule_; }

 private:
  std::optional<Capsule> capsule_;              // or
  std::shared_ptr<const StarSurface> surface_;  // offset outward by
  double out_um_ = 0;
};

}  // namespace plica
