// Normal and curvature of a polygon surface at its vertices.
#pragma once

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/star_surface.hpp"

namespace plica {

struct VertexBend {
  Vec3 normal;             // unit, outward
  double least_radius_um;  // least radius of convex curvature; infinity if flat or concave
};

/// Estimate from polygons only: area-weighted mean normal about a vertex, and the fitted quadratic surface through it.
/// An unused vertex gets +z.
std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons);

/// Evaluate on a smooth surface that contains the vertices.
std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons, const StarSurface& surface);

}  // namespace plica
