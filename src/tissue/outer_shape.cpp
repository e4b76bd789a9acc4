#include "tissue/outer_shape.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tissue/shapes/star_surface.hpp"

namespace plica {
namespace {

OuterShape::Gap gap_of(const Capsule& shell, const Vec3& point) {
  // Distance to the axis segment; on the cylinder it does not change along x.
  const double foot_x = std::clamp(point.x(), -shell.half_axis_um, shell.half_axis_um);
  const Vec3 from_axis(point.x() - foot_x, point.y(), point.z());
  const double distance = from_axis.norm();
  const Vec3 outward = distance > 0 ? Vec3(from_axis / distance) : Vec3(Vec3::UnitZ());
  Mat3 across = Mat3::Identity() - outward * outward.transpose();
  if (foot_x == point.x()) across -= Vec3::UnitX() * Vec3::UnitX().transpose();
  return {shell.radius_um - distance, -outward, -across / std::max(distance, 1e-12 * shell.radius_um)};
}

OuterShape::Gap gap_of(const StarSurface& surface, const Vec3& point) {
  const double far_um = 0.2 * surface.least_radius();
  if (point.norm() < far_um) return {far_um, -Vec3::UnitZ(), Mat3::Zero()};
  const Vec3 above = surface.along_ray(point);
  const bool is_near = (above - point).norm() <= far_um;
  if (!is_near && above.squaredNorm() > point.squaredNorm()) {
    const Vec3 outward = surface.bend(point).normal;
    return {(above - point).dot(outward), -outward, Mat3::Zero()};
  }
  const ClosestOnSurface closest = is_near ? surface.closest_by_ray(point) : surface.closest(point);
  Mat3 hessian = Mat3::Zero();
  for (const int i : {0, 1}) {
    const Vec3& tangent = closest.bend.tangents[i];
    hessian -= tangent * tangent.transpose() / (closest.bend.radii[i] + closest.signed_distance_um);
  }
  return {-closest.signed_distance_um, -closest.normal, hessian};
}

double depth_in(const Capsule& shell, const Vec3& point, const Vec3& outward) {
  // The shell's section is all circles of its radius R with centres on its axis. Of the line's ways out of each, the
  // longest is where its distance w from the centre is R times the axial part of `outward`.
  const double R = shell.radius_um, along = outward.x(), across = outward.z();
  const auto distance = [&](double centre) { return (centre - point.x()) * across + point.z() * along; };
  double centre = std::copysign(shell.half_axis_um, along);
  if (across != 0) {
    const double w = R * along * std::copysign(1.0, across);
    centre = std::clamp(point.x() + (w - point.z() * along) / across, -shell.half_axis_um, shell.half_axis_um);
  }
  const double w = distance(centre);
  return (centre - point.x()) * along - point.z() * across + std::sqrt(std::max(0.0, R * R - w * w));
}

}  // namespace

OuterShape OuterShape::moved_out(double by_um) const {
  OuterShape result = *this;
  if (capsule_)
    result.capsule_->radius_um += by_um;
  else
    result.out_um_ += by_um;
  return result;
}

OuterShape::Gap OuterShape::gap(const Vec3& point) const {
  if (capsule_) return gap_of(*capsule_, point);
  Gap gap = gap_of(*surface_, point);
  gap.value += out_um_;
  return gap;
}

double OuterShape::depth(const Vec3& point, const Vec3& outward) const {
  if (capsule_) return depth_in(*capsule_, point, outward);
  // By halves, from the place of the line that is farthest in.
  const auto inside = [&](double way) {
    const Vec3 x = point + way * outward;
    return x.norm() < 1e-9 || x.norm() < surface_->along_ray(x).norm() + out_um_;
  };
  double in = -point.dot(outward), out = in;  // nearest to the origin
  const double size = surface_->half_axes().maxCoeff();
  if (!inside(in)) return in;
  while (inside(out)) out += 0.1 * size;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (in + out);
    (inside(middle) ? in : out) = middle;
  }
  return in;
}

double OuterShape::volume() const {
  if (capsule_)
    return std::numbers::pi * capsule_->radius_um * capsule_->radius_um *
           (2 * capsule_->half_axis_um + 4 * capsule_->radius_um / 3);
  // Steiner's formula for the parallel surface.
  double mean_curvature = 0;  // its integral
  if (out_um_ != 0) {
    const Vectors directions = even_directions(20'000);
    for (const Vec3& direction : directions) {
      const SurfaceBend bend = surface_->bend(surface_->in_direction(direction));
      mean_curvature += 0.5 * (1 / bend.radii[0] + 1 / bend.radii[1]) * surface_->area_over(direction) * 4 *
                        std::numbers::pi / static_cast<double>(directions.size());
    }
  }
  const double d = out_um_;
  return surface_->volume() + d * (surface_->area() + d * (mean_curvature + d * 4 * std::numbers::pi / 3));
}

}  // namespace plica
