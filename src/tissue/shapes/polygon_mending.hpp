// Polygons that cannot be meshed: edges that are too short, angles that are too wide.
#pragma once

#include "tissue/shapes/surface_polygons.hpp"

namespace plica {

/// Mends `cells.surface`, whose polygons are about `points`, and counts what it did.
void mend_polygons(const Vectors& points, const StarSurface& surface, const PolygonOptions& options,
                   CellPolygons& cells);

/// MeshError for the first polygon that, seen along the surface's normal at its point, is not convex or winds more than
/// once.
void check_polygons(const Vectors& points, const StarSurface& surface, const PolygonSurface& polygons);

/// Angles of a polygon at its corners, seen along `normal`, in degrees: over 180 where it is not convex.
std::vector<double> polygon_angles_deg(const Vectors& vertices, const std::vector<std::size_t>& polygon,
                                       const Vec3& normal);

}  // namespace plica
