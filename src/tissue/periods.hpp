// Periodic surface: vertices of one period, and images at its end.
#pragma once

#include <cmath>
#include <vector>

#include "core/vector.hpp"

namespace plica {

struct Periods {
  Vec3 length = Vec3::Zero();  // um along x, y, z; 0 if not periodic
  // Original of each vertex, whole periods away; mostly the vertex itself. Empty: not periodic.
  std::vector<std::size_t> originals = {};

  [[nodiscard]] bool is_used() const { return !originals.empty(); }
  [[nodiscard]] std::size_t original(std::size_t vertex) const { return is_used() ? originals[vertex] : vertex; }

  /// Return the whole periods nearest to an offset.
  [[nodiscard]] Vec3 whole(const Vec3& way) const {
    Vec3 periods = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (length[axis] > 0) periods[axis] = length[axis] * std::round(way[axis] / length[axis]);
    return periods;
  }
};

}  // namespace plica
