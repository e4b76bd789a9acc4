// Whether a surface faces one way: an open sheet, in contrast to a closed surface or a tube.
#pragma once

#include <array>

#include "tissue/hexahedron.hpp"

namespace plica {

/// Sum over the facets of a surface.
struct Facing {
  Vec3 area_vectors = Vec3::Zero();
  double area = 0;

  void add(const std::array<Vec3, 4>& facet) {
    const Vec3 vector = facet_area_vector(facet);
    area_vectors += vector;
    area += vector.norm();
  }

  /// |Sum of area vectors| / sum of areas is 0 for a closed surface and 1 for a flat one.
  [[nodiscard]] bool is_one_way() const { return area_vectors.norm() > 0.2 * area; }
};

}  // namespace plica
