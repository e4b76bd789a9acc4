// Sheet one cell thick: polygons on a surface, extruded inward along its normals to prisms.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "tissue/prisms.hpp"
#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/star_surface.hpp"

namespace plica {

/// Normal and curvature of a polygon surface at a vertex.
struct VertexBend {
  Vec3 normal;             // unit, outward
  double least_radius_um;  // least radius of convex curvature; infinity if flat or concave
};

/// Estimate from polygons only: area-weighted mean normal about a vertex, and the fitted quadratic surface through it.
/// An unused vertex gets +z.
std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons);

/// Evaluate on a smooth surface that contains the vertices.
std::vector<VertexBend> vertex_bends(const PolygonSurface& polygons, const StarSurface& surface);

struct ExtrudedSheet : PrismSheet {
  std::string asked_um;         // the height, or "asked for" if each cell has its own
  std::size_t lower_cells = 0;  // more than 1 % lower than requested, due to curvature
  std::size_t lowest_cell = 0;
  double lowest_um = 0;  // height of the lowest cell
};

/// Largest cell height as a fraction of the least principal radius of curvature. At 1 the basal face would be a line or
/// a point.
inline constexpr double largest_height_share = 0.65;

/// Extrude each cell inward, along the surface normals at its vertices, by its height: one number, or one per cell. A
/// vertex takes the mean height of its cells. Above 0.7 of the bound (`largest_height_share` times the least radius
/// there) it is lowered smoothly and never exceeds the bound. If basal faces would still fold, on a rough surface, it
/// is lowered further. `bends` are those of the surface at its vertices. MeshError, with the row of the cell, if a
/// height is not positive, the number of heights is wrong, or a basal face is turned over.
ExtrudedSheet extrude(const PolygonSurface& polygons, std::span<const VertexBend> bends,
                      std::span<const double> heights_um);

/// Return a remark if cells are lower than requested.
void note_lower_cells(const ExtrudedSheet& sheet, std::vector<std::string>& remarks);

/// Return the height of each prism: mean distance from its apical to its basal vertices, um.
std::vector<double> prism_heights(const PrismSheet& sheet);

}  // namespace plica
