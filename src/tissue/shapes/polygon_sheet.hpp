// A patch of an epithelium: even polygons on a rectangle, flat or bent.
#pragma once

#include <array>
#include <cstdint>

#include "tissue/shapes/polygon_embryo.hpp"
#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

struct SheetShape {
  double length_um = 100;  // along x, of the apical surface
  double width_um = 100;   // along y
  // One over the radius along x and y, 1/um; positive where the apical side is outside. With the second alone, or the
  // first, the surface is part of a cylinder; with both, of a torus: a sphere where they are equal, a saddle where they
  // have different signs. Lengths along x are those of the line y = 0.
  std::array<double, 2> curvature_per_um = {0, 0};
};

/// Apical faces up (+z), the middle of the patch at the origin. As many cells, evenly spread; other seeds spread them
/// otherwise. MeshError when the patch would close upon itself or narrow to less than half of its length at y = 0.
Tissue build_sheet(const SheetShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells);

/// The polygons of all places in the rectangle, its middle at the origin, that are nearer to their point than to any
/// other, in the plane z = 0. MeshError when two points are in one place.
PolygonSurface rectangle_polygons(const Vectors& points, double length_um, double width_um);

}  // namespace plica
