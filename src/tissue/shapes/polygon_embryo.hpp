// Embryos of polygonal cells on a smooth surface: an egg, or cells about points that were measured.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tissue/prisms.hpp"
#include "tissue/shapes/egg_surface.hpp"
#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

struct PolygonCells {
  double height_um = 35;
  PolygonSplit split = PolygonSplit::diagonals;
  int layers = 1;                 // of elements, from basal to apical
  double least_edge_ratio = 0.3;  // to the mean edge: shorter ones are lengthened
};

/// An egg with as many cells, evenly spread; other seeds spread them otherwise. MeshError as egg_surface and
/// polygons_of_points.
Tissue build_egg(const EggShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells);

struct MeasuredPoints {
  Vectors points;          // um; one a cell, on a closed surface around the origin
  double depth_um = 0;     // how far they lie below the apical surface
  Vec3 scale = {1, 1, 1};  // after that, along x, y, z
};

/// A cell about each point, in their order; the apical surface is a smooth one through them. MeshError names rows.
Tissue build_about_points(const MeasuredPoints& measured, const PolygonCells& cells);

struct GivenSurface {
  PolygonSurface surface;               // the cells' apical faces
  std::vector<double> heights_um = {};  // cells; empty: all as PolygonCells says
  Vec3 scale = {1, 1, 1};               // of its vertices, along x, y, z
  bool centre = false;                  // moves its middle, the mean of its faces' middles by area, to the origin
  bool mend = true;                     // see given_surface.hpp
};

/// A tissue whose apical surface is that of polygons, and the reason where it has no `outer_shape`: that is a smooth
/// surface through the vertices, which has to be closed around the origin and close to them.
struct SurfaceTissue {
  Tissue tissue;
  std::string why_no_shape;
};

/// A cell under each face, in their order: inward along the normals of that smooth surface, or where there is none, the
/// mean normals of the faces. MeshError as check_and_mend and extrude.
SurfaceTissue build_under_surface(GivenSurface given, const PolygonCells& cells);

}  // namespace plica
