// Surfaces of polygons, a cell a face, as modellers, image tools and vertex models write them.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct PolygonFile {
  PolygonSurface surface;                   // as the file has it: unchecked, but corners are vertices that there are
  std::map<std::string, CellArray> arrays;  // numbers a face
};

/// Wavefront's OBJ: lines `v x y z` and `f a b c ...`; the rest is passed over. No arrays.
PolygonFile polygons_in_obj(std::string_view text);
/// Geomview's OFF: a vertex or a face a line; colours are passed over. No arrays.
PolygonFile polygons_in_off(std::string_view text);
/// Stanford's PLY, text or binary. Numbers of the faces (not lists) are arrays.
PolygonFile polygons_in_ply(std::string_view bytes);
// All of these: MeshError, which names the line or element, when the text is no such file.

/// Reads a file by its ending: .obj, .off, .ply; .vtp, .vtu and .vtk through VTK, with all arrays of one number a face;
/// .h5, .hdf5 and .hf5 as tyssue's save_datasets writes it. FileError when it cannot be read, or the plica was built
/// without what that takes; MeshError when it is something else.
PolygonFile read_polygon_file(const std::filesystem::path& file);

// What read_polygon_file chooses among.
PolygonFile read_vtk_polygons(const std::filesystem::path& file);
PolygonFile read_vertex_model(const std::filesystem::path& file);

}  // namespace plica
