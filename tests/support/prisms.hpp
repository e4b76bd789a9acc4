// Sheets of polygonal cells that tests share.
#pragma once

#include "support/tissues.hpp"
#include "tissue/prisms.hpp"

namespace plica::support {

/// Hexagons with edges of `edge_um`, in rows along x that lie beside each other, flat at z = 0 with their basal faces
/// `height_um` below; the middle of the sheet is at 0.
PrismSheet honeycomb(int columns, int rows, double edge_um, double height_um);

/// Turns the wall between two cells that share one away from the rim, so that the two beside it meet: the two lose a
/// corner each, those gain one.
void exchange_neighbours(PrismSheet& sheet, std::size_t cell, std::size_t other);

/// A honeycomb whose cells have four to eight corners, in an irregular order: vertices are displaced by up to `size` of
/// an edge, alike at the apex and the base, and every seventh wall is turned.
PrismSheet irregular_polygons(int columns, int rows, double edge_um, double height_um, double size, unsigned seed);

/// Area of each polygon, um^2, from triangles about the mean of its corners.
inline std::vector<double> polygon_areas(const PolygonSurface& surface) {
  std::vector<double> areas;
  for (const auto& polygon : surface.polygons)
    areas.push_back(fan_about(surface.vertices, polygon, mean_corner(surface.vertices, polygon)).area);
  return areas;
}

/// Lengths of the edges, um.
inline std::vector<double> edge_lengths(const PolygonSurface& surface) {
  std::vector<double> lengths;
  for (const PolygonEdge& edge : polygon_edges(surface))
    lengths.push_back((surface.vertices[edge.vertices[1]] - surface.vertices[edge.vertices[0]]).norm());
  return lengths;
}

/// Number of polygons with 0, 1, 2, 3, ... corners.
inline std::vector<std::size_t> corner_counts(const PolygonSurface& surface) {
  std::vector<std::size_t> counts;
  for (const auto& polygon : surface.polygons) {
    if (counts.size() <= polygon.size()) counts.resize(polygon.size() + 1, 0);
    ++counts[polygon.size()];
  }
  return counts;
}

/// Volume of each cell, um^3.
inline std::vector<double> prism_volumes(const PrismSheet& sheet) {
  const Tissue tissue = tissue_from_prisms(sheet, PolygonSplit::diagonals, 1);
  std::vector<double> volumes;
  for (const Cell& cell : tissue.cells) volumes.push_back(cell_volume(tissue, cell, tissue.rest_positions));
  return volumes;
}

/// The same, bent: from a place at height z = 0 or -height to where it lies.
template <class Place>
PrismSheet bent(PrismSheet sheet, const Place& place) {
  for (Vectors* vertices : {&sheet.apical, &sheet.basal})
    for (Vec3& x : *vertices) x = place(Vec3(x));
  return sheet;
}

}  // namespace plica::support
