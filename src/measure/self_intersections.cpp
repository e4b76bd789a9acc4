#include "measure/self_intersections.hpp"

#include <algorithm>
#include <array>
#include <optional>

#include "core/box_grid.hpp"

namespace plica {
namespace {

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

bool have_common_node(const Facet& a, const Facet& b) {
  return std::ranges::any_of(a.nodes, [&](NodeId node) { return std::ranges::find(b.nodes, node) != b.nodes.end(); });
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> crossing_facets(std::span<const Facet> facets,
                                                                 std::span<const Vec3> positions) {
  std::vector<Fan> fans;
  std::vector<Box> boxes;
  double largest = 1e-6, sum = 0;
  for (const Facet& facet : facets) {
    const Box& box = boxes.emplace_back(box_of(fans.emplace_back(fan_of(facet, positions)).points));
    const double size = (box.high - box.low).maxCoeff();
    largest = std::max(largest, size);
    sum += size;
  }
  // Cubes as large as most facets; but a facet much larger than others must not take too many.
  const BoxGrid grid(std::max(largest / 30, 1.5 * sum / static_cast<double>(std::max<std::size_t>(facets.size(), 1))),
                     boxes);
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::uint32_t> found;
  for (std::size_t a = 0; a < facets.size(); ++a) {
    grid.find_overlapping(boxes[a], found, a + 1);
    for (const std::size_t b : found)
      if (!have_common_node(facets[a], facets[b]) && cross(fans[a], fans[b])) pairs.emplace_back(a, b);
  }
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
