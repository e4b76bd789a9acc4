// Polygons that cover a surface, such as apical faces of cells: properties, and repair of those that cannot be meshed,
// with short edges or wide angles.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "core/vector.hpp"

namespace plica {

/// Periods of a surface, which has the vertices of one period, and images at its end.
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

/// Lloyd's relaxation: points move toward the centroids of their cells.
struct Lloyd {
  // As many as bring the areas' variation to 8 % from a random start; more would make a crystal of it.
  static constexpr int rounds = 35;

  /// Share of the way to the centroid. Beyond it, because long waves converge slowly; not while cells still change
  /// their neighbours.
  static constexpr double share(int round) { return round < 5 ? 1 : 1.5; }
};

struct PolygonSurface {
  Vectors vertices;                                // um
  std::vector<std::vector<std::size_t>> polygons;  // vertices of each, counter-clockwise seen from outside
  Periods periods = {};                            // sides of images of vertices are one edge
};

/// Edge of two polygons, or of one at a boundary.
struct PolygonEdge {
  std::array<std::size_t, 2> vertices;  // in the order of the polygon on its left
  std::size_t left, right;              // polygons; right is no_polygon at a rim
};

inline constexpr std::size_t no_polygon = static_cast<std::size_t>(-1);

Vec3 mean_corner(const Vectors& vertices, const std::vector<std::size_t>& polygon);

/// Return half the sum of (p_i - c) x (p_i+1 - c) about the mean c of the corners: the normal of the polygon times its
/// area seen along it.
Vec3 area_vector(const Vectors& vertices, const std::vector<std::size_t>& polygon);

/// Area of the triangles between the sides of the polygon and `centre`, um^2, and their centroid.
struct PolygonFan {
  double area;
  Vec3 centroid;
};
PolygonFan fan_about(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& centre);

/// Return every edge once, in order of polygons. MeshError if an edge runs the same way in two polygons or belongs to
/// more than two.
std::vector<PolygonEdge> polygon_edges(const PolygonSurface& surface);

/// Return the polygons across the sides of each, in order of its sides; no_polygon at a boundary.
std::vector<std::vector<std::size_t>> polygon_neighbours(const PolygonSurface& surface);

struct PolygonOptions {
  double least_edge = 0.15;        // relative to the mean edge length: shorter ones are lengthened
  double largest_angle_deg = 165;  // between two sides, seen along the normal: wider ones are sharpened
  double furthest_share = 0.1;     // largest distance of a point from the surface / its radius
};

/// Result of a repair.
struct MendedPolygons {
  std::size_t lengthened_edges = 0;   // edges that were too short
  std::size_t sharpened_corners = 0;  // angles that were too wide
  std::size_t left_edges = 0;         // still too short, for very uneven points
  std::size_t left_corners = 0;       // still too wide
  std::size_t passes = 0;             // number of passes over the surface; at most 60
  double furthest_move_um = 0;        // largest displacement of a vertex
};

/// Orientation of the polygons of a surface, and admissible moves of their vertices.
struct MendingRules {
  Vectors normals;                                                  // polygons; unit
  std::function<Vec3(const PolygonEdge&)> along;                    // direction of an edge, present or intended; unit
  std::function<Vec3(std::size_t vertex, const Vec3& to)> allowed;  // admissible place nearest to `to`
};

MendedPolygons mend_polygons(const MendingRules& rules, const PolygonOptions& options, PolygonSurface& surface);

/// Return remarks on the repairs; empty if none.
std::vector<std::string> remarks_on(const MendedPolygons& mended);

/// Return the defect of a polygon, seen along `normal`: "is not convex, ..." or "crosses itself"; empty if none.
std::string polygon_flaw(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& normal);

/// Return the angles of a polygon at its corners, seen along `normal`, degrees: over 180 where it is not convex.
std::vector<double> polygon_angles_deg(const Vectors& vertices, const std::vector<std::size_t>& polygon,
                                       const Vec3& normal);

}  // namespace plica
