// Voronoi polygons on a rectangle.
#pragma once

#include <array>
#include <cstdint>

#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

/// Rectangle in the plane z = 0, centred at the origin.
struct Rectangle {
  std::array<double, 2> size_um;                     // along x and y
  std::array<bool, 2> is_periodic = {false, false};  // whether it is periodic along them
};

/// Return this number of evenly distributed points; the seed selects the arrangement.
Vectors even_points(const Rectangle& rectangle, std::size_t count, std::uint64_t seed);

/// Return one polygon per point. If the rectangle is periodic, polygons extend across its ends, and vertices beyond one
/// end are images of those at the other. MeshError if two points coincide, or a period has so few that a polygon meets
/// itself or another twice.
PolygonSurface rectangle_polygons(const Vectors& points, const Rectangle& rectangle);

}  // namespace plica
