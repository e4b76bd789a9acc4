// Repair of polygons that cannot be meshed: short edges, wide angles.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

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
struct MendingGround {
  Vectors normals;                                                  // polygons; unit
  std::function<Vec3(const PolygonEdge&)> along;                    // direction of an edge, present or intended; unit
  std::function<Vec3(std::size_t vertex, const Vec3& to)> allowed;  // admissible place nearest to `to`
};

MendedPolygons mend_polygons(const MendingGround& ground, const PolygonOptions& options, PolygonSurface& surface);

/// Return remarks on the repairs; empty if none.
std::vector<std::string> remarks_on(const MendedPolygons& mended);

/// Return the defect of a polygon, seen along `normal`: "is not convex, ..." or "crosses itself"; empty if none.
std::string polygon_flaw(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& normal);

/// Return the angles of a polygon at its corners, seen along `normal`, degrees: over 180 where it is not convex.
std::vector<double> polygon_angles_deg(const Vectors& vertices, const std::vector<std::size_t>& polygon,
                                       const Vec3& normal);

}  // namespace plica
