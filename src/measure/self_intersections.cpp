#include "measure/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>

namespace plica {
namespace {

struct Box {
  Vec3 low, high;

  [[nodiscard]] bool overlaps(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
};

Box box_of(std::span<const Vec3> points) {
  Box box{points[0], points[0]};
  for (const Vec3& point : points.subspan(1)) {
    box.low = box.low.cwiseMin(point);
    box.high = box.high.cwiseMax(point);
  }
  return box;
}

using Triangle = std::array<Vec3, 3>;

// Interval along `line` in which a triangle crosses a plane; empty unless it extends to both sides by more than
// `least`.
std::optional<std::pair<double, double>> cut(const Triangle& t, const Vec3& origin, const Vec3& normal,
                                             const Vec3& line, double least) {
  std::array<double, 3> height{};
  for (int i = 0; i < 3; ++i) height[i] = normal.dot(t[i] - origin);
  if (*std::ranges::min_element(height) > -least || *std::ranges::max_element(height) < least) return std::nullopt;
  std::pair<double, double> range{1e300, -1e300};
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    if ((height[i] > 0) == (height[next] > 0)) continue;
    const double at = line.dot(t[i] + height[i] / (height[i] - height[next]) * (t[next] - t[i]));
    range = {std::min(range.first, at), std::max(range.second, at)};
  }
  return range;
}

// Whether two triangles cross: each extends to both sides of the other's plane, and their intervals on the intersection
// line of the planes overlap in more than a point (Moller 1997).
bool cross(const Triangle& a, const Triangle& b, double least) {
  const auto normal = [](const Triangle& t) { return Vec3((t[1] - t[0]).cross(t[2] - t[0]).normalized()); };
  const Vec3 normal_a = normal(a), normal_b = normal(b), line = normal_a.cross(normal_b).normalized();
  const auto of_a = cut(a, b[0], normal_b, line, least), of_b = cut(b, a[0], normal_a, line, least);
  return of_a && of_b && std::min(of_a->second, of_b->second) - std::max(of_a->first, of_b->first) > least;
}

// Corners of a facet, their mean, and the four triangles between them.
struct Fan {
  std::array<Vec3, 5> points;

  [[nodiscard]] Triangle triangle(int i) const { return {points[i], points[(i + 1) % 4], points[4]}; }
};

Fan fan_of(const Facet& facet, std::span<const Vec3> positions) {
  Fan fan;
  fan.points[4].setZero();
  for (int i = 0; i < 4; ++i) {
    fan.points[i] = positions[facet.nodes[i].index()];
    fan.points[4] += fan.points[i] / 4;
  }
  return fan;
}

bool cross(const Fan& a, const Fan& b) {
  const Box box_a = box_of(a.points), box_b = box_of(b.points);
  const double size = std::max((box_a.high - box_a.low).maxCoeff(), (box_b.high - box_b.low).maxCoeff());
  for (int i = 0; i < 4; ++i) {
    const Triangle of_a = a.triangle(i);
    const Box box = box_of(of_a);
    if (!box.overlaps(box_b)) continue;
    for (int k = 0; k < 4; ++k) {
      const Triangle of_b = b.triangle(k);
      if (box.overlaps(box_of(of_b)) && cross(of_a, of_b, 1e-9 * size)) return true;
    }
  }
  return false;
}

// Bounding boxes of facets, sorted by their start along the longest axis of the surface.
struct SortedBoxes {
  SortedBoxes(std::span<const Facet> facets, std::span<const Vec3> positions) : facet(facets.size()) {
    std::vector<Box> boxes;
    boxes.reserve(facets.size());
    Eigen::AlignedBox3d whole;
    for (const Facet& of : facets) {
      std::array<Vec3, 4> corners;  // their mean lies within
      for (int i = 0; i < 4; ++i) corners[i] = positions[of.nodes[i].index()];
      boxes.push_back(box_of(corners));
      whole.extend(boxes.back().low).extend(boxes.back().high);
    }
    int longest = 0;
    if (!facets.empty()) whole.sizes().maxCoeff(&longest);
    std::iota(facet.begin(), facet.end(), std::size_t{0});
    std::ranges::sort(facet, {}, [&](std::size_t f) { return boxes[f].low[longest]; });
    for (int axis = 0; axis < 3; ++axis)
      for (const std::size_t f : facet) {
        low[axis].push_back(boxes[f].low[(longest + axis) % 3]);
        high[axis].push_back(boxes[f].high[(longest + axis) % 3]);
      }
  }

  /// Later boxes that overlap one, in a part of `found`, which has room for all. Most candidates do not overlap, so
  /// each index is written and kept by incrementing the count: faster than branching.
  [[nodiscard]] std::span<const std::size_t> overlapping(std::size_t i, std::span<std::size_t> found) const {
    const auto end = std::upper_bound(low[0].begin() + static_cast<std::ptrdiff_t>(i), low[0].end(), high[0][i]);
    std::size_t count = 0;
    for (std::size_t k = i + 1; k < static_cast<std::size_t>(end - low[0].begin()); ++k) {
      found[count] = k;
      count += static_cast<std::size_t>((low[1][k] <= high[1][i]) & (low[1][i] <= high[1][k]) &
                                        (low[2][k] <= high[2][i]) & (low[2][i] <= high[2][k]));
    }
    return found.first(count);
  }

  std::vector<std::size_t> facet;
  std::array<std::vector<double>, 3> low, high;
};

bool have_common_node(const Facet& a, const Facet& b) {
  return std::ranges::any_of(a.nodes, [&](NodeId node) { return std::ranges::find(b.nodes, node) != b.nodes.end(); });
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> crossing_facets(std::span<const Facet> facets,
                                                                 std::span<const Vec3> positions) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  const SortedBoxes boxes(facets, positions);
  std::vector<std::size_t> found(facets.size());
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (const std::size_t k : boxes.overlapping(i, found)) {
      const auto [a, b] = std::minmax(boxes.facet[i], boxes.facet[k]);
      if (!have_common_node(facets[a], facets[b]) && cross(fan_of(facets[a], positions), fan_of(facets[b], positions)))
        pairs.emplace_back(a, b);
    }
  std::ranges::sort(pairs);
  return pairs;
}

std::size_t self_intersections(const Tissue& tissue, std::span<const Vec3> positions) {
  return crossing_facets(tissue.apical_facets, positions).size() +
         crossing_facets(tissue.basal_facets, positions).size();
}

CellSet self_intersecting_cells(const Tissue& tissue, std::span<const Vec3> positions) {
  CellSet cells(tissue.cells.size(), false);
  for (const auto* facets : {&tissue.apical_facets, &tissue.basal_facets})
    for (const auto& [a, b] : crossing_facets(*facets, positions))
      for (const std::size_t facet : {a, b}) cells[(*facets)[facet].cell.index()] = true;
  return cells;
}

}  // namespace plica
