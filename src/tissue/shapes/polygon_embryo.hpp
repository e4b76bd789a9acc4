// Embryos of polygonal cells on a smooth surface: an egg, or cells about measured points.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tissue/placement.hpp"
#include "tissue/prisms.hpp"
#include "tissue/shapes/egg_surface.hpp"
#include "tissue/shapes/polygon_surface.hpp"

namespace plica {

struct PolygonCells {
  double height_um = 35;
  PolygonSplit split = PolygonSplit::diagonals;
  int layers = 1;                 // element layers from basal to apical
  double least_edge_ratio = 0.3;  // relative to the mean edge: shorter ones are lengthened
};

/// Build an egg with this number of evenly distributed cells; the seed selects the arrangement. MeshError as
/// egg_surface and polygons_of_points.
Tissue build_egg(const EggShape& shape, std::size_t count, std::uint64_t seed, const PolygonCells& cells);

struct MeasuredPoints {
  Vectors points;       // um; one per cell, on a closed surface around the origin
  double depth_um = 0;  // depth below the apical surface, before the placement
  Placement placement = {};
};

/// Build one cell per point, in order; the apical surface is a smooth one through the points. MeshError names rows.
Tissue build_about_points(const MeasuredPoints& measured, const PolygonCells& cells);

struct GivenSurface {
  PolygonSurface surface;               // apical faces of the cells
  std::vector<double> heights_um = {};  // cells; empty: as in PolygonCells
  Placement placement = {};             // centred on its area centroid
  bool mend = true;                     // see given_surface.hpp
  bool keep_largest = false;            // likewise
};

/// Tissue with the given apical surface, and the reason if it has no `outer_shape`, the smooth surface through the
/// vertices, which must be closed around the origin and close to them.
struct SurfaceTissue {
  Tissue tissue;
  std::string why_no_shape;
  std::vector<std::size_t> kept;  // faces that became cells
};

/// Return the values of the kept faces.
CellArray of_kept(const CellArray& of_faces, const std::vector<std::size_t>& kept);

/// Build one cell per face that is kept, in order: inward along the normals of that smooth surface, else along the mean
/// normals of the faces. MeshError as check_and_mend and extrude.
SurfaceTissue build_under_surface(GivenSurface given, const PolygonCells& cells);

}  // namespace plica
