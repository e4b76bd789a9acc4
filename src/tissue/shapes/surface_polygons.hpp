// Voronoi cells of points on a closed surface, and points distributed evenly over it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/star_surface.hpp"

namespace plica {

/// Delaunay triangulation of points on a closed surface, in real distances.
///
/// The convex hull of directions in scaled coordinates of the surface is a triangulation, but Delaunay only on that
/// unit sphere: on an egg 2.7 times longer than wide its cells are 2.2 times longer than wide. Edges are flipped until
/// each is Delaunay by the side lengths of its triangles. (Rejected: the hull alone; a restricted Delaunay
/// triangulation in space, which requires a filled interior and adds little for a sheet sampled this finely.)
struct SurfaceTriangulation {
  std::vector<std::array<std::size_t, 3>> triangles;  // points, counter-clockwise seen from outside
  std::vector<std::array<std::size_t, 3>> across;     // triangle beyond the side opposite to each corner
};

/// Return the convex hull of the directions of points in scaled coordinates of the surface. MeshError, naming rows
/// (from 0), if there are fewer than 12 points, one is not finite, two coincide (1e-6 um), one lies behind another, or
/// all lie on one side of the origin.
SurfaceTriangulation hull_triangulation(const Vectors& points, const StarSurface& surface);

/// Flip edges until opposite angles of each add up to at most 180 degrees; return the number of flips. MeshError if
/// this does not terminate.
std::size_t flip_to_delaunay(const Vectors& points, SurfaceTriangulation& triangulation);

/// Whether every triangle faces outward, seen from the origin.
bool looks_outward(const Vectors& points, const SurfaceTriangulation& triangulation);

/// Return the triangles about each point, counter-clockwise, beginning with the one whose first side leads to the
/// lowest neighbour.
std::vector<std::vector<std::size_t>> triangles_about(std::size_t point_count,
                                                      const SurfaceTriangulation& triangulation);

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

/// Return random points with uniform density per area, evened out by Lloyd's relaxation: each point moves repeatedly to
/// the centroid of its polygon (dual_polygons). Polygon areas then vary by about 8 % (coefficient of variation);
/// about 70 % are hexagons. The seed determines the points; they are sorted by x. MeshError for fewer than 12.
Vectors even_points(const StarSurface& surface, std::size_t count, std::uint64_t seed);

}  // namespace plica
