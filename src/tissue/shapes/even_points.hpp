// Points spread evenly over a closed surface, irregular as cells of an epithelium are.
#pragma once

#include <cstdint>

#include "tissue/shapes/star_surface.hpp"

namespace plica {

/// Random points, as many everywhere by area, then evened out by Lloyd's relaxation: each point moves to the middle of
/// its polygon (surface_polygons.hpp) again and again. The areas of the polygons then vary by some 8 % (coefficient of
/// variation), some 70 % of them are hexagons. The same seed gives the same points. Their order is by x and says
/// nothing else. MeshError for fewer than 12.
Vectors even_points(const StarSurface& surface, std::size_t count, std::uint64_t seed);

}  // namespace plica
