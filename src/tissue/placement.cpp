#include "tissue/placement.hpp"

#include <Eigen/Geometry>
#include <numbers>

namespace plica {

void Placement::turn(Vectors& points) const {
  Mat3 turned = scale.asDiagonal();
  for (int axis = 0; axis < 3; ++axis)
    if (rotate_deg[axis] != 0)
      turned =
          Eigen::AngleAxisd(rotate_deg[axis] * std::numbers::pi / 180, Vec3::Unit(axis)).toRotationMatrix() * turned;
  for (Vec3& point : points) point = rotate_deg.isZero(0) ? Vec3(point.cwiseProduct(scale)) : Vec3(turned * point);
}

void move_to_origin(Vectors& points, const Vec3& centre) {
  for (Vec3& point : points) point -= centre;
}

}  // namespace plica
