// Polygons that cover a surface, such as apical faces of cells, and their properties.
#pragma once

#include <array>
#include <vector>

#include "core/vector.hpp"
#include "tissue/periods.hpp"

namespace plica {

/// Polygon surface, closed or with boundary.
struct PolygonSurface {
  Vectors vertices;                                // um
  std::vector<std::vector<std::size_t>> polygons;  // vertices of each, counter-clockwise seen from outside
  Periods periods = {};                            // sides of images of vertices are one edge
};

/// Edge of two polygons, or of one at a boundary.
struct PolygonEdge {
  std::array<std::size_t, 2> vertices;  // in the order of the polygon on its left
  std::size_t left, right;              // polygons; right is no_polygon at a rim
};

inline constexpr std::size_t no_polygon = static_cast<std::size_t>(-1);

/// Return half the sum of (p_i - c) x (p_i+1 - c) about the mean c of the corners: the normal of the polygon times its
/// area seen along it.
Vec3 area_vector(const Vectors& vertices, const std::vector<std::size_t>& polygon);

/// Area of the triangles between the sides of the polygon and `centre`, um^2, and their centroid.
struct PolygonFan {
  double area;
  Vec3 centroid;
};
PolygonFan fan_about(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& centre);

/// Return the area of each polygon, um^2, from triangles about the mean of its corners.
std::vector<double> polygon_areas(const PolygonSurface& surface);

/// Return every edge once, in order of polygons. MeshError if an edge runs the same way in two polygons or belongs to
/// more than two.
std::vector<PolygonEdge> polygon_edges(const PolygonSurface& surface);

/// Return the polygons across the sides of each, in order of its sides; no_polygon at a boundary.
std::vector<std::vector<std::size_t>> polygon_neighbours(const PolygonSurface& surface);

/// Return the lengths of the edges, um.
std::vector<double> edge_lengths(const PolygonSurface& surface);

/// Return the number of polygons with 0, 1, 2, 3, ... corners.
std::vector<std::size_t> corner_counts(const PolygonSurface& surface);

}  // namespace plica
