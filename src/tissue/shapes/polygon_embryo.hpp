// Embryos of polygonal cells on a smooth surface: an egg, or cells about measured points.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tissue/mesh_input.hpp"
#include "tissue/prisms.hpp"
#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/shapes/star_surface.hpp"

namespace plica {

/// Egg from a few lengths: an ellipsoid whose dorsal side is flatter than its ventral side.
///
/// With d the direction in coordinates scaled by the half-axes, and s = d_x, the scaled radius is
///   1 + even s^2 (1 - s^2) + odd d_z s^2 (1 - s^2 / 2).
/// The even term raises the shoulders on all sides and makes the poles blunter. The odd term raises the dorsal
/// and lowers the ventral shoulders, and tilts the poles dorsally, like bending the axis. Both keep the middle section.
/// (Two blended half-axes c would not flatten both sides; a bent axis is not a function of direction.)
struct EggShape {
  double length_um = 500;  // along x
  double width_um = 180;   // along y
  double height_um = 180;  // along z; ventral at -z
  // Sags: distance of the outline in the plane y = 0, at its middle, from its chord from 20 to 80 % of the length. Both
  // or none; default: an ellipsoid, with sags of a tenth of its height. Measured embryo: 17 and 7.
  std::optional<double> belly_sag_um, back_sag_um;
};

/// Make the surface. MeshError if a length is not positive, or no such surface has these sags: each may be about 4 to
/// 17 % of the height; smaller ones would make the dorsal side concave.
StarSurface egg_surface(const EggShape& shape);

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

/// Return the smooth surface through the vertices. MeshError if it is not closed around the origin and close to them.
StarSurface smooth_surface(const PolygonSurface& surface);

/// Return a smooth surface, moved out so that no vertex lies beyond it, as the reference apical surface.
OuterShape shape_around(const StarSurface& smooth, const Vectors& vertices);

/// Tissue with the given apical surface, and the reason if it has no `outer_shape`, the smooth surface through the
/// vertices, which must be closed around the origin and close to them.
struct SurfaceTissue {
  Tissue tissue;
  std::string why_no_shape;
  std::vector<std::size_t> kept;  // faces that became cells
};

CellArray of_kept(const CellArray& of_faces, const std::vector<std::size_t>& kept);

/// Build one cell per face that is kept, in order: inward along the normals of that smooth surface, else along the mean
/// normals of the faces. MeshError as check_and_mend and extrude.
SurfaceTissue build_under_surface(GivenSurface given, const PolygonCells& cells);

}  // namespace plica
