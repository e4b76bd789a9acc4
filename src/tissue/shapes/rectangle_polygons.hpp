// Polygons on a rectangle: of all places that are nearer to one point than to any other.
#pragma once

#include <array>
#include <cstdint>

#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

/// In the plane z = 0, its middle at the origin.
struct Rectangle {
  std::array<double, 2> size_um;                     // along x and y
  std::array<bool, 2> is_periodic = {false, false};  // whether it repeats itself along them
};

/// As many points, evenly spread; other seeds spread them otherwise.
Vectors even_points(const Rectangle& rectangle, std::size_t count, std::uint64_t seed);

/// A polygon about each point. Where the rectangle repeats itself, polygons lie across its ends, and vertices beyond
/// one end are images of those at the other. MeshError when two points are in one place, or so few in a period that a
/// polygon meets itself or another polygon twice.
PolygonSurface rectangle_polygons(const Vectors& points, const Rectangle& rectangle);

}  // namespace plica
