// Delaunay triangulation of points on a closed surface, in real distances.
//
// The convex hull of directions in scaled coordinates of the surface is a triangulation, but Delaunay only on that unit
// sphere: on an egg 2.7 times longer than wide its cells are 2.2 times longer than wide. Edges are flipped until each
// is Delaunay by the side lengths of its triangles. (Rejected: the hull alone; a restricted Delaunay triangulation in
// space, which requires a filled interior and adds little for a sheet sampled this finely.)
#pragma once

#include <array>
#include <vector>

#include "tissue/shapes/star_surface.hpp"

namespace plica {

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

}  // namespace plica
