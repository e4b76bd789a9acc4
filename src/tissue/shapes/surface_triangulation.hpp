// The Delaunay triangulation of points on a closed surface, in real distances.
//
// The convex hull of the directions in the surface's scaled coordinates is a triangulation, but Delaunay only on that
// unit sphere: on an egg 2.7 times longer than wide its cells come out 2.2 times longer than wide. Edges are flipped
// until each is Delaunay by the lengths of its triangles' sides. (Rejected: the hull alone; a restricted Delaunay
// triangulation in space, which wants the interior filled and says little more on a sheet sampled this finely.)
#pragma once

#include <array>
#include <vector>

#include "tissue/shapes/star_surface.hpp"

namespace plica {

struct SurfaceTriangulation {
  std::vector<std::array<std::size_t, 3>> triangles;  // points, counter-clockwise seen from outside
  std::vector<std::array<std::size_t, 3>> across;     // triangle beyond the side opposite to each corner
};

/// The convex hull of the points' directions in the surface's scaled coordinates. MeshError, which names rows (from 0),
/// when there are fewer than 12 points, one is not finite, two are in one place (1e-6 um), one lies behind another,
/// or all lie on one side of the origin.
SurfaceTriangulation hull_triangulation(const Vectors& points, const StarSurface& surface);

/// Flips edges until the two angles opposite to each add up to at most 180 degrees; returns the number of flips.
/// MeshError when that does not come to an end.
std::size_t flip_to_delaunay(const Vectors& points, SurfaceTriangulation& triangulation);

/// Whether every triangle looks outward, seen from the origin.
bool looks_outward(const Vectors& points, const SurfaceTriangulation& triangulation);

/// The triangles about each point, counter-clockwise, beginning with the one whose first side goes to the lowest
/// neighbour.
std::vector<std::vector<std::size_t>> triangles_about(std::size_t point_count,
                                                      const SurfaceTriangulation& triangulation);

}  // namespace plica
