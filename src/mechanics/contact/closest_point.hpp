// Closest points: on a triangle to a point, and between two segments.
#pragma once

#include <array>
#include <optional>

#include "core/vector.hpp"

namespace plica {

struct ClosestPoint {
  std::array<double, 3> weights;  // barycentric; sum to 1
  double squared_distance;        // um^2
};

/// Return the point of triangle a, b, c nearest to p; the triangle may be degenerate.
ClosestPoint closest_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Fractions of the two segments, from first to second end.
struct PlacesOnSegments {
  double on_first, on_second;
};

/// Return the closest points of segments a b and c d if both are interior; empty if an end is as near, or the segments
/// are parallel (within 0.001) or have no length.
std::optional<PlacesOnSegments> nearest_inside(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);

}  // namespace plica
