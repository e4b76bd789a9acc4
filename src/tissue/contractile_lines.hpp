// Lines of nodes along which cells contract. The tension of the edges of a cell is spread over those of its face or
// walls where these have several elements (docs/decisions/0005-spread-springs.md).
#pragma once

#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Chain of nodes whose segments are springs in series, with a share of the tension of an edge.
struct ContractileLine {
  std::vector<NodeId> nodes;
  EdgeDirection direction;  // for polygons, the nearer of along and across
  double along = 0;         // alignment with x: squared cosine
  double share = 1;         // tension / tension of an edge
  double in_series = 1;     // number of such chains in series that are as soft as an edge of this tension
};

/// Return the lines of each cell on one side; cells. They are
/// - on the faces of grid cells, the lines of element edges (Cell::lines);
/// - on polygons without inner nodes, their edges;
/// - on other polygons, all element edges of the face: each of its quadrilaterals gives its four edges the same
///   stiffness and the same tension, so that both have the energy of the edges of the polygon when the face is
///   stretched evenly;
/// - on walls, the lines of element edges from base to apex, those at corners with half a share of each wall.
std::vector<std::vector<ContractileLine>> contractile_lines(const Tissue& tissue, CellSide side);

}  // namespace plica
