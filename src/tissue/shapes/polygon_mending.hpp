// Polygons that cannot be meshed: edges that are too short, angles that are too wide.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

struct PolygonOptions {
  double least_edge = 0.15;        // of the mean length of an edge: shorter ones are lengthened
  double largest_angle_deg = 165;  // between two sides, seen along the normal: wider ones are sharpened
  double furthest_share = 0.1;     // of its radius, that a point may be from the surface
};

/// What was mended, and what could not be.
struct MendedPolygons {
  std::size_t lengthened_edges = 0;   // edges that were too short
  std::size_t sharpened_corners = 0;  // angles that were too wide
  std::size_t left_edges = 0;         // still too short in the end, among points that are very uneven
  std::size_t left_corners = 0;       // still too wide
  std::size_t passes = 0;             // over the surface, until nothing was left to mend; at most 60
  double furthest_move_um = 0;        // of a vertex by mending
};

/// How the polygons of a surface lie, and how their vertices may move.
struct MendingGround {
  Vectors normals;                                                  // polygons; unit
  std::function<Vec3(const PolygonEdge&)> along;                    // the way that an edge runs, or should run; unit
  std::function<Vec3(std::size_t vertex, const Vec3& to)> allowed;  // the place nearest to `to`, where it may go
};

MendedPolygons mend_polygons(const MendingGround& ground, const PolygonOptions& options, PolygonSurface& surface);

/// What was mended, in the words of whoever wants to know; nothing of a surface that was fine.
std::vector<std::string> remarks_on(const MendedPolygons& mended);

/// What is wrong with a polygon, seen along `normal`: it "is not convex, ..." or "crosses itself"; empty of a good one.
std::string polygon_flaw(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& normal);

/// Angles of a polygon at its corners, seen along `normal`, in degrees: over 180 where it is not convex.
std::vector<double> polygon_angles_deg(const Vectors& vertices, const std::vector<std::size_t>& polygon,
                                       const Vec3& normal);

}  // namespace plica
