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
};

MeshQuality mesh_quality(const Tissue& tissue, const Vectors& positions);

/// Worst corner of an element: 1 is a brick, 0 is flat.
double min_scaled_jacobian(const Tissue& tissue, const Vectors& positions);

/// Smallest Jacobian of an element's corner over that at rest: 0 is flat, below it the corner is inside out.
double min_corner_jacobian_ratio(const Tissue& tissue, const Vectors& positions);

}  // namespace plica
