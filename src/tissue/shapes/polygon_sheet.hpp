// A patch of an epithelium: even polygons on a rectangle, flat or bent.
#pragma once

#include <array>
#include <cstdint>

#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {

struct SheetShape {
  double length_um = 100;  // along x, of the apical surface
  double width_um = 100;   // along y
  // One over the radius along x and y, 1/um; positive where the apical side is outside. With the second alone, or the
  // first, the surface is part of a cylinder; with both, of a torus: a sphere where they are equal, a saddle where they
  // have different signs. Lengths along x are those of the line y = 0.
  std::array<double, 2> curvature_per_um = {0, 0};
  // Whether it repeats itself along x and y, so that it has no rim there; it is not bent along these. Cells are those
  // whose middles lie in one period.
  std::array<bool, 2> is_periodic = {false, false};
};

/// Apical faces up (+z), the middle of the patch at the origin. As many cells, evenly spread; other seeds spread them
/// otherwise. MeshError when the patch would close upon itself or narrow to less than half of its length at y = 0, and
/// as rectangle_polygons.
Tissue build_sheet(const SheetShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells);

/// The same about points in the flat rectangle, a cell each.
Tissue build_sheet(const SheetShape& shape, const Vectors& points, const PolygonCells& cells);

}  // namespace plica
