// Patch of an epithelium: even Voronoi polygons on a flat or curved rectangle.
#pragma once

#include <array>
#include <cstdint>

#include "tissue/shapes/polygon_embryo.hpp"
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

struct SheetShape {
  double length_um = 100;  // along x, of the apical surface
  double width_um = 100;   // along y
  // Curvature along x and y, 1/um; positive if the apical side is outside. With one of them, the surface is part of a
  // cylinder; with both, of a torus: a sphere if equal, a saddle if of opposite sign. Lengths along x are those of the
  // line y = 0.
  std::array<double, 2> curvature_per_um = {0, 0};
  // Whether it is periodic along x and y (no boundary there); it must not be curved along these. Cells are those with
  // centres in one period.
  std::array<bool, 2> is_periodic = {false, false};
};

/// Build the sheet with apical faces up (+z) and its middle at the origin, with this number of evenly distributed
/// cells; the seed selects the arrangement. MeshError if the patch would overlap itself or narrow to less than half of
/// its length at y = 0, and as rectangle_polygons.
Tissue build_sheet(const SheetShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells);

/// Build the sheet with one cell per point in the flat rectangle.
Tissue build_sheet(const SheetShape& shape, const Vectors& points, const PolygonCells& cells);

}  // namespace plica
