// Cells about points on a closed surface: the polygons of all places that are nearer to their point than to any other.
#pragma once

#include "tissue/shapes/polygon_mending.hpp"
#include "tissue/shapes/star_surface.hpp"
#include "tissue/shapes/surface_triangulation.hpp"

namespace plica {

struct CellPolygons : MendedPolygons {
  PolygonSurface surface;         // vertices on the surface; polygon i belongs to point i
  std::size_t flipped_edges = 0;  // of the hull's, until its triangles were Delaunay
};

/// The dual of the points' Delaunay triangulation in real distances: vertices are the circumcentres of its triangles,
/// put on the surface. Three cells meet at every vertex. Edges that are too short for a mesh are lengthened, by moving
/// their vertices apart; angles near 180 degrees are sharpened. The points themselves are taken where they are next to
/// the surface.
/// MeshError, which names rows (from 0) and places, when the points do not cover the surface (hull_triangulation), one
/// is too far from it, or a polygon is not convex, seen along the surface's normal, after mending.
CellPolygons polygons_of_points(const Vectors& points, const StarSurface& surface, const PolygonOptions& options = {});

/// MeshError for the first polygon that, seen along the surface's normal at its point, is not convex or winds more than
/// once.
void check_polygons(const Vectors& points, const StarSurface& surface, const PolygonSurface& polygons);

/// The same from a triangulation of points on the surface, before mending and unchecked.
PolygonSurface dual_polygons(const Vectors& points, const SurfaceTriangulation& triangulation,
                             const StarSurface& surface);

}  // namespace plica
