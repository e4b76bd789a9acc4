// Tissue from polygons: each cell is a prism over a polygon, made of hexahedra over quadrilaterals. Only this folder
// depends on the split.
#pragma once

#include <vector>

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Layer of adjacent prisms: lateral faces between neighbours are bilinear.
struct PrismSheet {
  Vectors apical, basal;                        // vertices, one below the other; um
  std::vector<std::vector<std::size_t>> cells;  // vertices of each polygon, counter-clockwise seen from outside
  Periods periods = {};
};

enum class PolygonSplit {
  /// Split by diagonals. An odd polygon gets a node in the middle of an edge, which hangs on its ends, so the split
  /// does not affect the neighbour. A triangle is split into kites, whose nodes hang on its corners.
  diagonals,
  /// Split into kites, one per corner: from there to the middles of its edges and that of the polygon. All nodes are
  /// free.
  kites
};

/// Build the tissue with each prism cut into `layers`. Images of vertices hang on their originals, as one node of the
/// mechanics. Polygons are split for the best element quality. Sets region "all".
Tissue tissue_from_prisms(const PrismSheet& sheet, PolygonSplit split, int layers);

}  // namespace plica
