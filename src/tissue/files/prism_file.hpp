// Prisms in polygon files: an apical and a basal polygon per cell.
#pragma once

#include "tissue/files/polygon_file.hpp"
#include "tissue/shapes/given_prisms.hpp"

namespace plica {

/// Return the prisms of a file whose face arrays `cell` and `is_apical` (1 or 0) name the cell and the side of each
/// face: one face per cell and side, the k-th corner of the basal one below that of the apical one. Cells come in order
/// of their numbers, with the arrays of their apical faces. MeshError, naming a cell, if that does not hold, or
/// neighbours join other corners to a column.
GivenPrisms prisms_in(const PolygonFile& file);

}  // namespace plica
