// External prisms: cells given by both of their polygons, checked, and repaired where that is safe.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tissue/mesh_input.hpp"
#include "tissue/prisms.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {

struct GivenPrisms {
  PrismSheet sheet;                         // not periodic
  std::map<std::string, CellArray> arrays;  // one number per cell; NaN: no value
  std::vector<std::string> remarks = {};    // what its reader omitted
};

/// Build one cell per prism, in order; `height_um` of `cells` is not used. With `mend`, short edges are lengthened and
/// wide angles sharpened on both sides, each within its tangent planes. A centre is the mean of all corners. The tissue
/// has an `outer_shape` as build_under_surface.
///
/// MeshError, naming a cell and its place, if a corner is not finite or occurs twice in a cell; an edge has more than
/// two cells, or runs alike in both; cells are in pieces; a polygon is not convex; apical polygons are not
/// counter-clockwise seen from the apical side; or an element of a cell is inverted.
SurfaceTissue build_prisms(GivenPrisms given, const Placement& placement, bool mend, const PolygonCells& cells);

}  // namespace plica
