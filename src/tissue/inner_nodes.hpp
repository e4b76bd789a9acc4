// Nodes inside the faces of polygonal cells, such as the middle of a polygon split into kites.
#pragma once

#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Return a flag per node: whether it is a free node inside the apical or basal face of a polygonal cell, on none of
/// its edges. Nothing but the cell itself moves such a node, so it may stand out of the surface of the tissue as a
/// dimple. (Grid cells have none: their inner lines run on from cell to cell.)
std::vector<bool> inner_nodes_of_polygons(const Tissue& tissue);

}  // namespace plica
