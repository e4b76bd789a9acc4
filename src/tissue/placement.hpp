// Scale, rotation and position of coordinates from a file.
#pragma once

#include "core/vector.hpp"

namespace plica {

struct Placement {
  Vec3 scale = {1, 1, 1};       // along x, y, z
  Vec3 rotate_deg = {0, 0, 0};  // afterwards, about x, then y, then z
  bool centre = false;          // afterwards, move the centre to the origin

  /// Scale and rotate points.
  void turn(Vectors& points) const;
};

/// Move points by minus `centre`.
void move_to_origin(Vectors& points, const Vec3& centre);

}  // namespace plica
