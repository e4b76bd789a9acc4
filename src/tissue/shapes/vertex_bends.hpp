// Which way a surface of polygons faces at its vertices, and how sharply it bends there.
#pragma once

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/star_surface.hpp"

namespace plica {

struct VertexBend {
  Vec3 normal;             // unit, outward
  double least_radius_um;  // of curvature, where it bends inward as a ball does; infinity where it is flat or hollow
};

/// Of the polygons alone: the mean of the normals about a vertex by area, and the quadratic surface through it that is
/// nearest to the other vertices of its polygons. A vertex that no polygon has faces +z.
std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons);

/// Of a smooth surface on which the vertices lie.
std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons, const StarSurface& surface);

}  // namespace plica
