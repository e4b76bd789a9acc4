// How many walls lie between cells: rows about the midline, rings about a region.
#pragma once

#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Twice the number of cells that each cell's middle is away from the midline of the belly, going from cell to cell
/// through walls the shortest way: 0, 2, 4, ... where cells lie on the midline, 1, 3, 5, ... where it runs between two
/// rows of them. -1 where no way leads. The midline is where the plane y = 0 cuts the apical surface, on the side
/// towards -z where the tissue has an outer shape.
std::vector<int> half_cells_from_midline(const Tissue& tissue);

/// The cells outside of a set that lie at most so many walls away from it.
CellSet cells_around(const Tissue& tissue, const CellSet& cells, int rings);

}  // namespace plica
