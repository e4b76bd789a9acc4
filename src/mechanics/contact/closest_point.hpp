// The place on a triangle nearest to a point.
#pragma once

#include <array>

#include "core/vector.hpp"

namespace plica {

struct ClosestPoint {
  std::array<double, 3> weights;  // of the corners; add up to 1
  double squared_distance;        // um^2
};

/// Of p to the triangle a, b, c, which may be a needle or a point.
ClosestPoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace plica
