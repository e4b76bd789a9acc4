// Polygons that cover a surface, as the apical faces of cells do, and what can be asked of them.
#pragma once

#include <array>
#include <vector>

#include "core/vector.hpp"
#include "tissue/periods.hpp"

namespace plica {

/// Polygons that cover a surface, closed or with a rim.
struct PolygonSurface {
  Vectors vertices;                                // um
  std::vector<std::vector<std::size_t>> polygons;  // vertices of each, counter-clockwise seen from outside
  Periods periods = {};                            // sides of images of vertices are one edge
};

/// A side of two polygons, or of one at a rim.
struct PolygonEdge {
  std::array<std::size_t, 2> vertices;  // in the order of the polygon on its left
  std::size_t left, right;              // polygons; right is no_polygon at a rim
};

inline constexpr std::size_t no_polygon = static_cast<std::size_t>(-1);

/// Half the sum of (p_i - c) x (p_i+1 - c) about the mean c of the corners: its direction is the polygon's normal, its
/// length the area as seen along that.
Vec3 area_vector(const Vectors& vertices, const std::vector<std::size_t>& polygon);

/// Area of the triangles between the polygon's sides and `centre`, um^2, and their centroid.
struct PolygonFan {
  double area;
  Vec3 centroid;
};
PolygonFan fan_about(const Vectors& vertices, const std::vector<std::size_t>& polygon, const Vec3& centre);

/// Area of each polygon, um^2: of triangles about the mean of its corners.
std::vector<double> polygon_areas(const PolygonSurface& surface);

/// Every edge once, in the order of the polygons. MeshError when an edge runs the same way in two polygons or belongs
/// to more than two.
std::vector<PolygonEdge> polygon_edges(const PolygonSurface& surface);

/// Polygons across the sides of each, in the order of its sides; no_polygon at a rim.
std::vector<std::vector<std::size_t>> polygon_neighbours(const PolygonSurface& surface);

/// Lengths of the edges, um.
std::vector<double> edge_lengths(const PolygonSurface& surface);

/// How many polygons have 0, 1, 2, 3, ... corners.
std::vector<std::size_t> corner_counts(const PolygonSurface& surface);

}  // namespace plica
