// A sheet one cell thick: polygons on a surface, extruded inward to prisms.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tissue/prisms.hpp"
#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/vertex_bends.hpp"

namespace plica {

struct ExtrudedSheet : PrismSheet {
  std::string asked_um;         // the height, or "asked for" where each cell has its own
  std::size_t lower_cells = 0;  // more than 1 % lower than asked for, where the surface bends sharply
  std::size_t lowest_cell = 0;
  double lowest_um = 0;  // height of the lowest cell
};

/// The share of the least principal radius of curvature that a cell's height may reach. At 1 its basal face would be a
/// line or a point.
inline constexpr double largest_height_share = 0.65;

/// Extrudes each cell inward, along the surface's normals at its vertices, by its height: one number, or one a cell. A
/// vertex takes the mean of its cells' heights. Where that is more than 0.7 of the bound, `largest_height_share` times
/// the surface's least radius there, it is lowered, smoothly, and never passes that bound. Where basal faces would fold
/// all the same, on a rough surface, it is lowered further. `bends` are the surface's at its vertices. MeshError when a
/// height is not positive, there are not as many as cells, or a basal face is turned over, with the cell's row.
ExtrudedSheet extrude(const PolygonSurface& polygons, std::span<const VertexBend> bends,
                      std::span<const double> heights_um);

/// Says so where cells are lower than asked for.
void note_lower_cells(const ExtrudedSheet& sheet, std::vector<std::string>& remarks);

/// Volume of each prism, um^3: lateral faces ruled between apical and basal sides, faces fanned about their middles.
std::vector<double> prism_volumes(const PrismSheet& sheet);

/// Height of each prism: the mean distance from its apical to its basal vertices, um.
std::vector<double> prism_heights(const PrismSheet& sheet);

}  // namespace plica
