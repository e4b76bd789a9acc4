#include "tissue/shapes/surface_polygons.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tissue/hexahedral_mesh.hpp"
namespace plica {
namespace {

// The circumcentre of three points in their plane. That of a flat triangle is far away; it is brought back to within
// the longest side of the triangle's middle, where it still lies on the right side of its neighbours'.
Vec3 bounded_circumcentre(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 ab = b - a, ac = c - a, normal = ab.cross(ac);
  Vec3 middle = (a + b + c) / 3;
  const Vec3 centre =
      a + (ab.squaredNorm() * ac.cross(normal) + ac.squaredNorm() * normal.cross(ab)) / (2 * normal.squaredNorm());
  const double longest = std::max({ab.norm(), ac.norm(), (c - b).norm()});
  const Vec3 away = centre - middle;
  if (!centre.allFinite()) return middle;
  return away.norm() > longest ? Vec3(middle + away * (longest / away.norm())) : centre;
}

Vectors points_on(const Vectors& points, const StarSurface& surface, double furthest_share) {
  Vectors on;
  on.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ClosestOnSurface closest = surface.closest(points[i]);
    if (std::abs(closest.signed_distance_um) > furthest_share * closest.point.norm())
      throw MeshError(fmt::format(
          "row {} at ({:.4g}, {:.4g}, {:.4g}) um is {:.3g} um from the surface; move it "
          "within {:.0f} % of the radius",
          i, points[i].x(), points[i].y(), points[i].z(), closest.signed_distance_um, 100 * furthest_share));
    on.push_back(closest.point);
  }
  return on;
}

// The dual edge of a Delaunay triangulation is perpendicular to the line between its points, but on a bent surface a
// short one may run backwards a little.
MendedPolygons mend_about(const Vectors& points, const StarSurface& surface, const PolygonOptions& options,
                          PolygonSurface& polygons) {
  MendingGround ground;
  for (const Vec3& point : points) ground.normals.push_back(surface.bend(point).normal);
  ground.along = [&](const PolygonEdge& edge) {
    return Vec3(ground.normals[edge.left].cross(points[edge.right] - points[edge.left]).normalized());
  };
  ground.allowed = [&](std::size_t, const Vec3& to) { return surface.put_on(to); };
  return mend_polygons(ground, options, polygons);
}

}  // namespace

PolygonSurface dual_polygons(const Vectors& points, const SurfaceTriangulation& triangulation,
                             const StarSurface& surface) {
  constexpr auto unnumbered = static_cast<std::size_t>(-1);
  PolygonSurface dual;
  dual.polygons = triangles_about(points.size(), triangulation);
  // Vertices are numbered as the polygons come, whatever order the triangles have.
  std::vector<std::size_t> number(triangulation.triangles.size(), unnumbered);
  for (auto& polygon : dual.polygons)
    for (std::size_t& vertex : polygon) {
      const std::size_t triangle = vertex;
      if (number[triangle] == unnumbered) {
        number[triangle] = dual.vertices.size();
        const auto& [a, b, c] = triangulation.triangles[triangle];
        dual.vertices.push_back(surface.put_on(bounded_circumcentre(points[a], points[b], points[c])));
      }
      vertex = number[triangle];
    }
  return dual;
}

void check_polygons(const Vectors& points, const StarSurface& surface, const PolygonSurface& polygons) {
  for (std::size_t p = 0; p < polygons.polygons.size(); ++p) {
    const std::string flaw = polygon_flaw(polygons.vertices, polygons.polygons[p], surface.bend(points[p]).normal);
    const Vec3& at = points[p];
    if (!flaw.empty())
      throw MeshError(
          fmt::format("the cell of row {} at ({:.4g}, {:.4g}, {:.4g}) um {}; move its point away from its "
                      "neighbours', or space these more evenly",
                      p, at.x(), at.y(), at.z(), flaw));
  }
}

CellPolygons polygons_of_points(const Vectors& points, const StarSurface& surface, const PolygonOptions& options) {
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      throw MeshError(fmt::format("row {} is not a point; give three finite lengths in um", i));
  const Vectors on = points_on(points, surface, options.furthest_share);
  SurfaceTriangulation triangulation = hull_triangulation(on, surface);
  CellPolygons cells;
  cells.flipped_edges = flip_to_delaunay(on, triangulation);
  cells.surface = dual_polygons(on, triangulation, surface);
  static_cast<MendedPolygons&>(cells) = mend_about(on, surface, options, cells.surface);
  check_polygons(on, surface, cells.surface);
  return cells;
}

}  // namespace plica
