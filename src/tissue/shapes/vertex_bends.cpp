#include "tissue/shapes/vertex_bends.hpp"

#include <algorithm>
#include <limits>
#include <set>

namespace plica {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

std::vector<std::vector<std::size_t>> polygons_at_vertices(const PolygonSurface& polygons) {
  std::vector<std::vector<std::size_t>> about(polygons.vertices.size());
  for (std::size_t p = 0; p < polygons.polygons.size(); ++p)
    for (const std::size_t vertex : polygons.polygons[p]) about[vertex].push_back(p);
  return about;
}

// Least squares for the depth below the tangent plane, a u + b v + (e u^2 + 2 f u v + g v^2) / 2. The slopes a and b
// take up what the normal is wrong by. Where the vertices do not fix all of them, few ones or some on a conic, the
// flattest one.
double least_radius(const Vec3& at, const Vec3& normal, const Vectors& others) {
  const Vec3 u = normal.unitOrthogonal(), v = normal.cross(u);
  double size = 0;
  for (const Vec3& other : others) size = std::max(size, (other - at).norm());
  if (!(size > 0)) return infinity;
  const auto count = static_cast<Eigen::Index>(others.size());
  Eigen::MatrixXd rows(count, 5);
  Eigen::VectorXd depths(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const Vec3 way = (others[static_cast<std::size_t>(i)] - at) / size;
    const double x = way.dot(u), y = way.dot(v);
    rows.row(i) << x, y, 0.5 * x * x, x * y, 0.5 * y * y;
    depths[i] = -way.dot(normal);
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposed;
  decomposed.setThreshold(1e-3);  // on a conic nearly, rounding would be taken for curvature
  decomposed.compute(rows);
  const Eigen::VectorXd fit = decomposed.solve(depths);
  const double mean = 0.5 * (fit[2] + fit[4]), half = 0.5 * (fit[2] - fit[4]);
  const double curvature = mean + std::sqrt(half * half + fit[3] * fit[3]);
  return curvature > 1e-9 ? size / curvature : infinity;
}

}  // namespace

std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons) {
  const auto about = polygons_at_vertices(polygons);
  Vectors areas;
  for (const auto& polygon : polygons.polygons) areas.push_back(area_vector(polygons.vertices, polygon));
  std::vector<VertexBend> bends(polygons.vertices.size(), {Vec3::UnitZ(), infinity});
  for (std::size_t vertex = 0; vertex < bends.size(); ++vertex) {
    if (about[vertex].empty()) continue;
    Vec3 normal = Vec3::Zero();
    for (const std::size_t p : about[vertex]) normal += areas[p];
    if (normal.norm() > 0) bends[vertex].normal = normal.normalized();
    // Those of its polygons; at a rim, where these are one or two, of their neighbours, too.
    std::set<std::size_t> ring = {vertex};
    for (int rings = 0; rings < 2 && ring.size() < 9; ++rings)
      for (const std::size_t near : std::set(ring))
        for (const std::size_t p : about[near]) ring.insert(polygons.polygons[p].begin(), polygons.polygons[p].end());
    Vectors others;
    for (const std::size_t other : ring)
      if (other != vertex) others.push_back(polygons.vertices[other]);
    bends[vertex].least_radius_um = least_radius(polygons.vertices[vertex], bends[vertex].normal, others);
  }
  return bends;
}

std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons, const StarSurface& surface) {
  std::vector<VertexBend> bends;
  bends.reserve(polygons.vertices.size());
  for (const Vec3& vertex : polygons.vertices) {
    const SurfaceBend bend = surface.bend(vertex);
    double least = infinity;
    for (const double radius : bend.radii)
      if (radius > 0) least = std::min(least, radius);
    bends.push_back({bend.normal, least});
  }
  return bends;
}

}  // namespace plica
