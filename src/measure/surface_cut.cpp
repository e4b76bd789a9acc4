#include "measure/surface_cut.hpp"

#include <algorithm>
#include <cmath>

namespace plica {

Vec3 MaterialPoint::at(std::span<const Vec3> positions) const {
  Vec3 point = Vec3::Zero();
  for (int i = 0; i < 4; ++i) point += weights[i] * positions[nodes[i].index()];
  return point;
}

std::vector<SurfacePoint> cut_apical_surface(const Tissue& tissue, std::span<const Vec3> positions, int axis,
                                             const std::vector<bool>& wanted) {
  std::vector<SurfacePoint> points;
  for (std::size_t f = 0; f < tissue.apical_facets.size(); ++f) {
    if (!wanted[f]) continue;
    std::array<double, 4> height;
    for (int i = 0; i < 4; ++i) height[i] = positions[tissue.apical_facets[f].nodes[i].index()][axis];
    const auto [low, high] = std::minmax_element(height.begin(), height.end());
    if (*low > 0 || *high < 0) continue;
    // Point at height 0 between two points of the facet, given by weights and heights.
    const auto cross = [&](const std::array<double, 4>& a, double height_a, const std::array<double, 4>& b,
                           double height_b) {
      if (height_a * height_b > 0 || height_a == height_b) return;
      const double part = height_a / (height_a - height_b);
      SurfacePoint point{{tissue.apical_facets[f].nodes, {}}, f};
      for (int i = 0; i < 4; ++i) point.weights[i] = (1 - part) * a[i] + part * b[i];
      points.push_back(point);
    };
    constexpr std::array<double, 4> middle = {0.25, 0.25, 0.25, 0.25};
    const double height_of_middle = (height[0] + height[1] + height[2] + height[3]) / 4;
    for (int i = 0; i < 4; ++i) {
      std::array<double, 4> corner{}, next{};
      corner[i] = 1;
      next[(i + 1) % 4] = 1;
      cross(corner, height[i], next, height[(i + 1) % 4]);
      cross(corner, height[i], middle, height_of_middle);
    }
  }
  return points;
}

}  // namespace plica
