// Cells of a snapshot as polygons, for programs without hexahedra: a surface, or tables as in vertex models.
#pragma once

#include <string>

#include "record/mesh_writer.hpp"
#include "tissue/files/frame_file.hpp"

namespace plica {

/// Apical or basal polygons of the cells of a snapshot with their data, on the points that they use. Throws FileError
/// for damaged polygons, or missing ones of cells with several elements (older versions wrote none).
SurfaceMesh surface_of(const Frame& frame, bool apical);

/// CSV texts of a surface: vertices, half-edges and faces, with indices in the first column and the column names of
/// tyssue.
struct PolygonTables {
  std::string vertices;  // vert, x, y, z
  std::string edges;     // edge, srce, trgt, face, opposite (-1: none), dx, dy, dz, length
  std::string faces;     // face, x, y, z, num_sides, area, perimeter, then the data of the polygons
};

PolygonTables tables_of(const SurfaceMesh& surface);

}  // namespace plica
