// A surface that repeats itself: its vertices are those of one period, and of where that ends.
#pragma once

#include <cmath>
#include <vector>

#include "core/vector.hpp"

namespace plica {

struct Periods {
  Vec3 length = Vec3::Zero();  // um along x, y, z; 0 where it does not repeat itself
  // Of each vertex the one that stands for it, whole periods away; of most the vertex itself. Empty: no periods.
  std::vector<std::size_t> originals = {};

  [[nodiscard]] bool is_used() const { return !originals.empty(); }
  [[nodiscard]] std::size_t original(std::size_t vertex) const { return is_used() ? originals[vertex] : vertex; }

  /// The whole periods that come nearest to a way.
  [[nodiscard]] Vec3 whole(const Vec3& way) const {
    Vec3 periods = Vec3::Zero();
    for (int axis = 0; axis < 3; ++axis)
      if (length[axis] > 0) periods[axis] = length[axis] * std::round(way[axis] / length[axis]);
    return periods;
  }
};

}  // namespace plica
