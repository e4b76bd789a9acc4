// Cells about points on a closed surface: the polygons of all places that are nearer to their point than to any other.
#pragma once

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/star_surface.hpp"
#include "tissue/shapes/surface_triangulation.hpp"

namespace plica {

struct PolygonOptions {
  double least_edge = 0.15;        // of the mean length of an edge: shorter ones are lengthened
  double largest_angle_deg = 165;  // between two sides, seen along the normal: wider ones are sharpened
  double furthest_share = 0.1;     // of its radius, that a point may be from the surface
};

struct CellPolygons {
  PolygonSurface surface;             // vertices on the surface; polygon i belongs to point i
  std::size_t flipped_edges = 0;      // of the hull's, until its triangles were Delaunay
  std::size_t lengthened_edges = 0;   // edges that were too short
  std::size_t sharpened_corners = 0;  // angles that were too wide
  std::size_t left_edges = 0;         // still too short in the end, among points that are very uneven
  std::size_t left_corners = 0;       // still too wide
  std::size_t passes = 0;             // over the surface, until nothing was left to mend; at most 60
  double furthest_move_um = 0;        // of a vertex by mending
};

/// The dual of the points' Delaunay triangulation in real distances: vertices are the circumcentres of its triangles,
/// put on the surface. Three cells meet at every vertex. Edges that are too short for a mesh are lengthened, by moving
/// their vertices apart; angles near 180 degrees are sharpened. The points themselves are taken where they are next to
/// the surface.
/// MeshError, which names rows (from 0) and places, when the points do not cover the surface (hull_triangulation), one
/// is too far from it, or a polygon is not convex, seen along the surface's normal, after mending.
CellPolygons polygons_of_points(const Vectors& points, const StarSurface& surface, const PolygonOptions& options = {});

/// The same from a triangulation of points on the surface, before mending and unchecked.
PolygonSurface dual_polygons(const Vectors& points, const SurfaceTriangulation& triangulation,
                             const StarSurface& surface);

}  // namespace plica
