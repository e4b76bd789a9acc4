// Points distributed evenly over a closed surface, irregular like cells of an epithelium.
#pragma once

#include <cstdint>

#include "tissue/shapes/star_surface.hpp"

namespace plica {

/// Return random points with uniform density per area, evened out by Lloyd's relaxation: each point moves repeatedly to
/// the centroid of its polygon (surface_polygons.hpp). Polygon areas then vary by about 8 % (coefficient of variation);
/// about 70 % are hexagons. The seed determines the points; they are sorted by x. MeshError for fewer than 12.
Vectors even_points(const StarSurface& surface, std::size_t count, std::uint64_t seed);

}  // namespace plica
