// The polygon of a cell: places on its outline, how it is split into the quadrilaterals under its elements, its edges.
#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// The corners of a prism's two polygons, one above the other.
struct PrismCorners {
  std::span<const Vec3> basal, apical;
};

/// A place of one of the polygons, whose sides are straight.
Vec3 place_in(std::span<const Vec3> polygon, const OutlinePlace& place);

/// The part of the prism over a quadrilateral.
HexPoints part_over(const PrismCorners& prism, const OutlineQuad& quadrilateral);

/// Places round a polygon, in order, which its quadrilaterals may have as corners.
using OutlineRing = std::vector<OutlinePlace>;

/// Its corners.
OutlineRing corners_of_polygon(std::size_t corners);

/// A split by diagonals, in the way of the highest quality. Of an odd number of places there is one more, in the middle
/// of a side. A triangle is split into kites. Where no way is good, the other places are tried, and kites. Ways that
/// differ by rounding only are alike: the first is taken.
std::vector<OutlineQuad> best_split(const OutlineRing& places,
                                    const std::function<double(const std::vector<OutlineQuad>&)>& quality,
                                    const OutlineRing& other_places = {});

/// The quality of a split: the least scaled Jacobian of the parts of a prism.
double worst_part(const PrismCorners& prism, const std::vector<OutlineQuad>& split);

/// A kite a place: from there to the middles of the sides beside it and that of the polygon.
std::vector<OutlineQuad> split_into_kites(const OutlineRing& places);

/// Chains of nodes: along the sides of the basal and of the apical polygon, and up from each corner.
struct PolygonChains {
  std::vector<std::vector<NodeId>> basal, apical, lateral;
};

/// Of a list of corners as Cell::rest_shape.
inline PrismCorners prism_of(std::span<const Vec3> corners) {
  return {corners.first(corners.size() / 2), corners.last(corners.size() / 2)};
}

/// The cell's rest shape.
inline PrismCorners rest_prism(const Cell& cell) { return prism_of(cell.rest_shape); }

/// Sets edges and lines. How far an edge runs along, its ends at rest say.
void set_polygon_edges(const PolygonChains& chains, const Vectors& rest_positions, Cell& cell);

/// The walls of a cell without stops but its corners, as division needs them.
std::vector<std::vector<WallStop>> walls_between_corners(const Cell& cell);

/// Sets corners, edges and lines of a cell that has walls by their stops.
void set_corners_and_lines_of_walls(const Vectors& rest_positions, Cell& cell);

}  // namespace plica
