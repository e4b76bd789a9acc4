// From polygons to a tissue: each cell is a prism over a polygon, made of hexahedra over quadrilaterals that the
// polygon is split into. Nothing outside of this folder knows how.
#pragma once

#include <vector>

#include "tissue/periods.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// A layer of prisms side by side: walls between neighbours are bilinear.
struct PrismSheet {
  Vectors apical, basal;                        // vertices, one below the other; um
  std::vector<std::vector<std::size_t>> cells;  // vertices of each polygon, counter-clockwise seen from outside
  Periods periods = {};
};

enum class PolygonSplit {
  /// By diagonals. An odd polygon gets a node in the middle of an edge, which hangs on the edge's ends: so what the
  /// neighbour is made of does not matter. A triangle is split as by kites, whose nodes hang on its corners.
  diagonals,
  /// A kite a corner: from there to the middles of its edges and that of the polygon. All nodes are free.
  kites
};

/// Each prism cut into so many layers. Images of vertices hang on these: they are one node of the mechanics. Polygons
/// are split in the way that makes the best elements. Region "all" is set.
Tissue tissue_from_prisms(const PrismSheet& sheet, PolygonSplit split, int layers);

}  // namespace plica
