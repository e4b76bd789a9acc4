// Polygon of a cell: places on its outline, its split into quadrilaterals (one per element column), its edges.
// Lines of nodes along which cells contract. The tension of the edges of a cell is spread over those of its face or
// walls where these have several elements (docs/decisions/0005-spread-springs.md).
#pragma once

#include <array>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Corners of the two polygons of a prism, one above the other.
struct PrismCorners {
  std::span<const Vec3> basal, apical;
};

/// Return a place of one of the polygons, whose sides are straight.
Vec3 place_in(std::span<const Vec3> polygon, const OutlinePlace& place);

/// Return the part of the prism over a quadrilateral.
HexPoints part_over(const PrismCorners& prism, const OutlineQuad& quadrilateral);

/// Places around a polygon, in order, as candidate corners of quadrilaterals.
using OutlineRing = std::vector<OutlinePlace>;

/// Return its corners.
OutlineRing corners_of_polygon(std::size_t corners);

/// Return the split by diagonals with the highest quality. For an odd number of places one more is added, in the middle
/// of a side. A triangle is split into kites. If no split is good, other places and kites are tried. Splits that differ
/// by rounding count as equal: the first is taken.
std::vector<OutlineQuad> best_split(const OutlineRing& places,
                                    const std::function<double(const std::vector<OutlineQuad>&)>& quality,
                                    const OutlineRing& other_places = {});

/// Return the quality of a split: least scaled Jacobian of the parts of a prism.
double worst_part(const PrismCorners& prism, const std::vector<OutlineQuad>& split);

/// Return one kite per place: from there to the middles of its adjacent sides and that of the polygon.
std::vector<OutlineQuad> split_into_kites(const OutlineRing& places);

/// Chains of nodes: along the sides of the basal and apical polygon, and up from each corner.
struct PolygonChains {
  std::vector<std::vector<NodeId>> basal, apical, lateral;
};

/// Make the prism of a list of corners as in Cell::rest_shape.
inline PrismCorners prism_of(std::span<const Vec3> corners) {
  return {corners.first(corners.size() / 2), corners.last(corners.size() / 2)};
}

/// Return the rest shape of the cell.
inline PrismCorners rest_prism(const Cell& cell) { return prism_of(cell.rest_shape); }

/// Return the mean outward normal of the cell: that of its apical corners.
Vec3 outward_of(const Cell& cell, const Vectors& positions);

/// Return the alignment with x of a way on the surface with that normal: squared cosine of the angle to the projection
/// of x; 0.5 at a pole, where that is a point.
double alignment_with_x(const Vec3& way, const Vec3& outward);

/// Set edges and lines. Edge directions follow from reference positions of their ends.
void set_polygon_edges(const PolygonChains& chains, const Vectors& rest_positions, Cell& cell);

/// Return a flag per node: whether it is a free node inside the apical or basal face of a polygonal cell, on none of
/// its edges. Nothing but the cell itself moves such a node, so it may stand out of the surface of the tissue as a
/// dimple. (Grid cells have none: their inner lines run on from cell to cell.)
std::vector<bool> inner_nodes_of_polygons(const Tissue& tissue);

/// Return the node above each node of the elements of a cell, except the apical ones.
std::map<NodeId, NodeId> nodes_above(const Tissue& tissue, const Cell& cell);

/// Return the chains of free nodes between corners on both faces, and up from each corner. `basal` and `apical` are the
/// facets of the cell; nodes 4-7 of each element lie above 0-3. Empty if there are none: corners are not on the
/// boundary of the facets, in its order, or not above each other.
std::optional<PolygonChains> chains_about(const Tissue& tissue, std::span<const Facet> basal,
                                          std::span<const Facet> apical, const Cell& cell);

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

/// What is on the other side of a border of some cells: other cells of a set and, if `has_rim`, nothing.
struct OtherSide {
  CellSet cells;
  bool has_rim = false;
};

/// Return the lines of cables along the apical or basal border of `inside`, by the cell inside: the parts of edges
/// between two nodes, in series. Planes of symmetry are no border.
std::vector<std::vector<ContractileLine>> border_lines(const Tissue& tissue, CellSide side, const CellSet& inside,
                                                       const OtherSide& other);

}  // namespace plica
