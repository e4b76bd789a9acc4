#include "tissue/shapes/polygon_mending.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

constexpr std::size_t most_passes = 60;
constexpr double overshoot = 1.02;  // of what is wanted, so that the passes come to an end

// Moves that the edges and angles of one pass ask for; they are added up, so their order does not matter.
class Moves {
 public:
  explicit Moves(std::size_t vertex_count) : moves_(vertex_count, Vec3::Zero()) {}

  void add(std::size_t vertex, const Vec3& move) {
    moves_[vertex] += move;
    any_ = true;
  }

  [[nodiscard]] bool any() const { return any_; }

  void apply(const StarSurface& surface, Vectors& vertices) const {
    for (std::size_t v = 0; v < vertices.size(); ++v)
      if (!moves_[v].isZero(0)) vertices[v] = surface.put_on(vertices[v] + moves_[v]);
  }

 private:
  Vectors moves_;
  bool any_ = false;
};

// The way along the edge, its left cell's point being `left`. The dual edge of a Delaunay triangulation is
// perpendicular to the line between its points, but on a bent surface a short one may run backwards a little.
Vec3 edge_direction(const Vec3& left, const Vec3& right, const Vec3& normal) {
  return normal.cross(right - left).normalized();
}

std::size_t lengthen_edges(const std::vector<PolygonEdge>& edges, const Vectors& points, const Vectors& normals,
                           double least_um, const Vectors& vertices, Moves& moves) {
  std::size_t count = 0;
  for (const PolygonEdge& edge : edges) {
    const auto [from, to] = edge.vertices;
    const Vec3 direction = edge_direction(points[edge.left], points[edge.right], normals[edge.left]);
    const double length = (vertices[to] - vertices[from]).dot(direction);
    if (length >= least_um) continue;
    ++count;
    const Vec3 half = 0.5 * (overshoot * least_um - length) * direction;
    moves.add(from, -half);
    moves.add(to, half);
  }
  return count;
}

std::size_t sharpen_corners(const PolygonSurface& surface, const Vectors& normals, double largest_deg, Moves& moves) {
  const double bend = (180 - largest_deg) * std::numbers::pi / 180;
  std::size_t count = 0;
  for (std::size_t p = 0; p < surface.polygons.size(); ++p) {
    const auto& polygon = surface.polygons[p];
    const std::vector<double> angles = polygon_angles_deg(surface.vertices, polygon, normals[p]);
    for (std::size_t k = 0; k < polygon.size(); ++k) {
      if (angles[k] <= largest_deg) continue;
      ++count;
      const Vec3& before = surface.vertices[polygon[(k + polygon.size() - 1) % polygon.size()]];
      const Vec3& at = surface.vertices[polygon[k]];
      const Vec3& after = surface.vertices[polygon[(k + 1) % polygon.size()]];
      // A corner at height h over the line between its neighbours bends by about h (1 / l1 + 1 / l2).
      const double l1 = (at - before).norm(), l2 = (after - at).norm();
      const Vec3 outward = (after - before).cross(normals[p]).normalized();
      const double height = (at - before).dot(outward), wanted = overshoot * bend * l1 * l2 / (l1 + l2);
      moves.add(polygon[k], std::max(0.0, wanted - height) * outward);
    }
  }
  return count;
}

double mean_length(const std::vector<PolygonEdge>& edges, const Vectors& vertices) {
  double sum = 0;
  for (const PolygonEdge& edge : edges) sum += (vertices[edge.vertices[1]] - vertices[edge.vertices[0]]).norm();
  return sum / static_cast<double>(edges.size());
}

Vectors normals_at(const Vectors& points, const StarSurface& surface) {
  Vectors normals;
  normals.reserve(points.size());
  for (const Vec3& point : points) normals.push_back(surface.bend(point).normal);
  return normals;
}

}  // namespace

std::vector<double> polygon_angles_deg(const Vectors& vertices, const std::vector<std::size_t>& polygon,
                                       const Vec3& normal) {
  std::vector<double> angles;
  angles.reserve(polygon.size());
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Vec3& at = vertices[polygon[k]];
    Vec3 in = at - vertices[polygon[(k + polygon.size() - 1) % polygon.size()]];
    Vec3 out = vertices[polygon[(k + 1) % polygon.size()]] - at;
    in -= in.dot(normal) * normal;
    out -= out.dot(normal) * normal;
    angles.push_back(180 - std::atan2(in.cross(out).dot(normal), in.dot(out)) * 180 / std::numbers::pi);
  }
  return angles;
}

void mend_polygons(const Vectors& points, const StarSurface& surface, const PolygonOptions& options,
                   CellPolygons& cells) {
  Vectors& vertices = cells.surface.vertices;
  const Vectors start = vertices, normals = normals_at(points, surface);
  const std::vector<PolygonEdge> edges = polygon_edges(cells.surface);
  const double least_um = options.least_edge * mean_length(edges, vertices);
  for (;; ++cells.passes) {
    Moves moves(vertices.size());
    cells.left_edges = lengthen_edges(edges, points, normals, least_um, vertices, moves);
    cells.left_corners = sharpen_corners(cells.surface, normals, options.largest_angle_deg, moves);
    if (cells.passes == 0) {
      cells.lengthened_edges = cells.left_edges;
      cells.sharpened_corners = cells.left_corners;
    }
    if (!moves.any() || cells.passes == most_passes) break;
    moves.apply(surface, vertices);
  }
  for (std::size_t v = 0; v < vertices.size(); ++v)
    cells.furthest_move_um = std::max(cells.furthest_move_um, (vertices[v] - start[v]).norm());
}

void check_polygons(const Vectors& points, const StarSurface& surface, const PolygonSurface& polygons) {
  for (std::size_t p = 0; p < polygons.polygons.size(); ++p) {
    const auto& polygon = polygons.polygons[p];
    const std::vector<double> angles = polygon_angles_deg(polygons.vertices, polygon, surface.bend(points[p]).normal);
    double turn = 0;
    for (const double angle : angles) turn += 180 - angle;
    const double widest = *std::ranges::max_element(angles);
    // Convex at every corner and once around: it cannot cross itself.
    if (widest < 179 && std::abs(turn - 360) < 1 && polygon.size() > 2) continue;
    const Vec3& at = points[p];
    throw MeshError(
        fmt::format("the cell of row {} at ({:.4g}, {:.4g}, {:.4g}) um {}; its point should be further from "
                    "its neighbours', or these more even",
                    p, at.x(), at.y(), at.z(),
                    std::abs(turn - 360) < 1 ? fmt::format("is not convex, with a corner of {:.0f} degrees", widest)
                                             : "crosses itself"));
  }
}

}  // namespace plica
