// Shape of the apical or basal surface of a region: curvature, and depth below the cells around it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Curvature of a region's surface where it is in the middle, 1/um: that of the quadric nearest to its nodes; positive
/// where it bulges outward. Along an axis projected into the surface, or the mean curvature. Empty if nodes do not
/// determine it, or the axis is normal to the surface.
std::optional<double> curvature_per_um(const Tissue& tissue, CellSide side, const CellSet& region,
                                       std::optional<int> axis, std::span<const Vec3> positions);

/// Cells around a region, and their weights for each of some cells of it: 1/d^4 of their reference distance d, over the
/// sum, so that those nearest across a furrow count.
struct CellsAround {
  std::vector<CellId> cells;
  std::vector<std::vector<double>> weights;
};
CellsAround cells_around_region(const Tissue& tissue, const CellSet& region, std::span<const CellId> cells);

/// Depths of the apical surfaces of cells of a region below those of the cells around it, along their reference
/// normals, um, minus the reference values. Empty if there are none around.
std::vector<double> depths_below_border_um(const Tissue& tissue, const CellSet& region, std::span<const CellId> cells,
                                           std::span<const Vec3> positions);

}  // namespace plica
