// Voronoi cells of points on a closed surface.
#pragma once

#include "tissue/shapes/polygon_mending.hpp"
#include "tissue/shapes/star_surface.hpp"
#include "tissue/shapes/surface_triangulation.hpp"

namespace plica {

struct CellPolygons : MendedPolygons {
  PolygonSurface surface;         // vertices on the surface; polygon i belongs to point i
  std::size_t flipped_edges = 0;  // hull edges flipped until Delaunay
};

/// Return the dual of the Delaunay triangulation of the points in real distances: vertices are the circumcentres of its
/// triangles, projected onto the surface. Three cells meet at every vertex. Short edges are lengthened by moving their
/// vertices; angles near 180 degrees are sharpened. Points near the surface are projected onto it. MeshError, naming
/// rows (from 0) and places, if the points do not cover the surface (hull_triangulation), one is too far from it, or a
/// polygon is not convex along the surface normal after the repair.
CellPolygons polygons_of_points(const Vectors& points, const StarSurface& surface, const PolygonOptions& options = {});

/// Throw MeshError for the first polygon that, seen along the surface normal at its point, is not convex or winds more
/// than once.
void check_polygons(const Vectors& points, const StarSurface& surface, const PolygonSurface& polygons);

/// Return the dual polygons of a triangulation of points on the surface, unrepaired and unchecked.
PolygonSurface dual_polygons(const Vectors& points, const SurfaceTriangulation& triangulation,
                             const StarSurface& surface);

}  // namespace plica
