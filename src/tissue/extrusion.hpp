// Extrusion (T2): a cell that has come down to three walls leaves the sheet. Its three columns become one.
#pragma once

#include <span>
#include <vector>

#include "tissue/remesher.hpp"

namespace plica {

/// Whether a cell can leave: it has three walls, to three cells of at least four, and its columns belong to three
/// cells.
bool can_leave(const Sheet& sheet, CellId cell);

/// Take cells out, which can leave and share no neighbour; those whose neighbours would get bad elements stay and are
/// dropped from the list. `positions`, um, change with the tissue: the column that is left stands in the middle. Cells
/// and free nodes keep their order; neighbours get rest shapes as in turn_walls.
TissueChange take_out(Tissue& tissue, std::vector<CellId>& cells, Vectors& positions, const Unstretch& unstretch);

}  // namespace plica
