// How even a tissue's cells are.
#pragma once

#include "tissue/tissue.hpp"

namespace plica {

struct Spread {
  double min = 0, mean = 0, max = 0;
};

struct MeshQuality {
  Spread volume_um3;       // of cells
  Spread apical_area_um2;  // of cells
  Spread along_um;         // lengths of apical and basal edges along the axis, each cell's own
  Spread across_um;
  Spread height_um;                // lateral edges
  double min_scaled_jacobian = 1;  // of elements
  CellId worst_cell;               // whose element that is
};

/// What is to be told of polygons beside that.
struct PolygonQuality {
  Spread basal_area_um2;                   // of cells
  Spread apical_edge_um;                   // edges of apical polygons, each cell's own
  std::vector<std::size_t> corner_counts;  // how many cells have 0, 1, 2, 3, ... corners
  std::vector<std::size_t> neighbours;     // and how many have 0, 1, 2, ... cells beyond their walls
  std::size_t rim_cells = 0;               // cells with a wall that nobody shares
};

MeshQuality mesh_quality(const Tissue& tissue, const Vectors& positions);

PolygonQuality polygon_quality(const Tissue& tissue, const Vectors& positions);

/// Worst corner of an element: 1 is a brick, 0 is flat.
double min_scaled_jacobian(const Tissue& tissue, const Vectors& positions);

/// Smallest Jacobian of an element's corner over that at rest: 0 is flat, below it the corner is inside out.
double min_corner_jacobian_ratio(const Tissue& tissue, const Vectors& positions);

}  // namespace plica
