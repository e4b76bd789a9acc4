// The place on a triangle nearest to a point, and those on two segments nearest to each other.
#pragma once

#include <array>
#include <optional>

#include "core/vector.hpp"

namespace plica {

struct ClosestPoint {
  std::array<double, 3> weights;  // of the corners; add up to 1
  double squared_distance;        // um^2
};

/// Of p to the triangle a, b, c, which may be a needle or a point.
ClosestPoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// As parts of the ways from their first ends to their second ones.
struct PlacesOnSegments {
  double on_first, on_second;
};

/// Of the segments a b and c d, where both places lie inside them. Nothing where an end of one is as near, or where
/// they are parallel (within a thousandth) or have no length.
std::optional<PlacesOnSegments> nearest_inside(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace plica
