// Quality of the cells and elements of a tissue.
#pragma once

#include "tissue/tissue.hpp"

namespace plica {

struct Spread {
  double min = 0, mean = 0, max = 0;
};

struct MeshQuality {
  Spread volume_um3;       // of cells
  Spread apical_area_um2;  // of cells
  Spread along_um;         // apical and basal edges along the axis, per cell
  Spread across_um;
  Spread height_um;                // lateral edges
  double min_scaled_jacobian = 1;  // of elements
  CellId worst_cell;               // cell of that element
};

/// Further statistics of polygons.
struct PolygonQuality {
  Spread basal_area_um2;                   // of cells
  Spread apical_edge_um;                   // edges of apical polygons, per cell
  std::vector<std::size_t> corner_counts;  // number of cells with 0, 1, 2, 3, ... corners
  std::vector<std::size_t> neighbours;     // number of cells with 0, 1, 2, ... neighbours
  std::size_t rim_cells = 0;               // cells at a boundary
};

MeshQuality mesh_quality(const Tissue& tissue, const Vectors& positions);

PolygonQuality polygon_quality(const Tissue& tissue, const Vectors& positions);

/// Return the scaled Jacobian of an element: 1 for a brick, 0 if flat.
double min_scaled_jacobian(const Tissue& tissue, const Vectors& positions);

/// Corner of an element: its Jacobian / reference value (0 if flat, negative if inverted), and its cell.
struct CornerRatio {
  double ratio;
  CellId cell;
};

CornerRatio least_corner_ratio(const Tissue& tissue, const Vectors& positions);

}  // namespace plica
