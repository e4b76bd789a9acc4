// A frame's cells as polygons, for programs that know no hexahedra: one surface, or tables as vertex models have them.
#pragma once

#include <string>

#include "record/mesh_writer.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// The apical or the basal polygons of a frame's cells, with their numbers. Points are those that polygons use.
/// FileError when the frame has no polygons of cells of several elements (older versions wrote none), or damaged ones.
SurfaceMesh surface_of(const Frame& frame, bool apical);

/// The surface as CSV texts: vertices, half-edges and faces, each by its number in the first column; columns have the
/// names that tyssue gives them.
struct PolygonTables {
  std::string vertices;  // vert, x, y, z
  std::string edges;     // edge, srce, trgt, face, opposite (-1: none), dx, dy, dz, length
  std::string faces;     // face, x, y, z, num_sides, area, perimeter, then the polygons' numbers
};

PolygonTables tables_of(const SurfaceMesh& surface);

}  // namespace plica
