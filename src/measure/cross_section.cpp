#include "measure/cross_section.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "measure/cells.hpp"

namespace plica {
namespace {

constexpr double nothing_um = 1e-6;  // below this: rounding error

// Cells whose reference apical faces meet the plane at x, ordered by angle from the midline, left to right.
std::vector<std::pair<double, CellId>> ring_at(const Tissue& tissue, double x, const Vec3& outward) {
  std::map<CellId, double> angles;
  for (const Facet& facet : tissue.apical_facets) {
    Extent extent;
    for (const NodeId node : facet.nodes) extent.take(tissue.rest_positions[node.index()].x());
    if (extent.low > x || extent.high <= x) continue;
    Vec3 centre = mean_apical(tissue.cells[facet.cell.index()], tissue.rest_positions);
    if (std::abs(centre.y()) < nothing_um) centre.y() = 0;  // a cell opposite the midline counts as right
    angles[facet.cell] = std::atan2(centre.y(), centre.dot(outward));
  }
  std::vector<std::pair<double, CellId>> ring;
  ring.reserve(angles.size());
  for (const auto& [cell, angle] : angles) ring.emplace_back(angle, cell);
  std::ranges::stable_sort(ring, {}, &std::pair<double, CellId>::first);
  return ring;
}

// Second moments of area of a cell's facets, per area, about their mean; and their normal.
struct Moments {
  double area = 0;
  Vec3 normal = Vec3::Zero(), first = Vec3::Zero();
  Mat3 second = Mat3::Zero();

  void take(const std::array<Vec3, 4>& x) {
    const double g = 1 / std::sqrt(3.0);
    for (const double s : {-g, g})
      for (const double t : {-g, g}) {
        const Vec3 by_s = 0.25 * ((1 - t) * (x[1] - x[0]) + (1 + t) * (x[2] - x[3]));
        const Vec3 by_t = 0.25 * ((1 - s) * (x[3] - x[0]) + (1 + s) * (x[2] - x[1]));
        const Vec3 point = 0.25 * ((1 - s) * (1 - t) * x[0] + (1 + s) * (1 - t) * x[1] + (1 + s) * (1 + t) * x[2] +
                                   (1 - s) * (1 + t) * x[3]);
        const Vec3 facing = by_s.cross(by_t);
        const double part = facing.norm();
        area += part;
        normal += facing;
        first += part * point;
        second += part * point * point.transpose();
      }
  }

  [[nodiscard]] FaceShape shape() const {
    const Vec3 n = normal.normalized(), sideways = n.cross(Vec3::UnitX());
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    if (!(area > 0) || !(sideways.norm() > 1e-3)) return {none, none, none, none, none};
    const Vec3 across = sideways.normalized(), along = across.cross(n), middle = first / area;
    const Mat3 spread = second / area - middle * middle.transpose();
    const double aa = along.dot(spread * along), ac = along.dot(spread * across), cc = across.dot(spread * across);
    const double mean = 0.5 * (aa + cc), half = std::hypot(0.5 * (aa - cc), ac);
    const auto length = [](double moment) { return std::sqrt(12 * std::max(0.0, moment)); };  // side of the rectangle
    const double angle = 0.5 * std::atan2(2 * ac, aa - cc);
    return {length(mean + half), length(mean - half), std::abs(angle) * 180 / std::numbers::pi, length(aa), length(cc)};
  }
};

}  // namespace

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

std::vector<SectionCell> section_cells(const Tissue& tissue, const Vec3& outward) {
  const auto [low, high] = extent_along(tissue);
  std::vector<SectionCell> cells;
  std::vector<std::vector<std::pair<double, CellId>>> known;
  for (const int percent : {50, 25, 75}) {
    const auto ring = ring_at(tissue, low + 0.01 * percent * (high - low) + 1e-6 * (high - low), outward);
    if (std::ranges::count(known, ring) > 0) continue;
    known.push_back(ring);
    const auto is_left = [](const auto& entry) { return entry.first < 0; };
    const auto left = std::ranges::count_if(ring, is_left);
    const bool on_midline = std::ranges::count(ring, 0.0, &std::pair<double, CellId>::first) > 0;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const int place = static_cast<int>(i) - static_cast<int>(left);  // from the first that is not on the left
      cells.push_back({ring[i].second, percent, place < 0 || on_midline ? place : place + 1});
    }
  }
  return cells;
}

std::vector<FaceShape> apical_shapes(const Tissue& tissue, std::span<const CellId> cells,
                                     std::span<const Vec3> positions) {
  std::map<CellId, Moments> moments;
  for (const CellId cell : cells) moments[cell];
  for (const Facet& facet : tissue.apical_facets)
    if (const auto found = moments.find(facet.cell); found != moments.end())
      found->second.take(gather(positions, facet));
  std::vector<FaceShape> shapes;
  shapes.reserve(cells.size());
  for (const CellId cell : cells) shapes.push_back(moments.at(cell).shape());
  return shapes;
}

}  // namespace plica
