// Cell distances: rows about the midline, rings about a region.
#pragma once

#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Return twice the distance of each cell from the ventral midline, counted in cells along the shortest path through
/// lateral faces: 0, 2, 4, ... if cells lie on the midline, 1, 3, 5, ... if it runs between two rows; -1 if
/// unreachable. The midline is where the plane y = 0 cuts the apical surface, towards -z if the tissue has an outer
/// shape.
std::vector<int> half_cells_from_midline(const Tissue& tissue);

/// Return the cells outside of a set within a number of lateral faces from it.
CellSet cells_around(const Tissue& tissue, const CellSet& cells, int rings);

}  // namespace plica
