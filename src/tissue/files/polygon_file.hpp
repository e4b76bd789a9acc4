// Reading of polygon surfaces, one face per cell, from modelling software, image tools and vertex models.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct PolygonFile {
  PolygonSurface surface;                   // as in the file: unchecked, but corners are existing vertices
  std::map<std::string, CellArray> arrays;  // one number per face; NaN: no value
  std::vector<std::string> remarks = {};    // what was corrected or omitted
};

/// Parse Wavefront OBJ: lines `v x y z` and `f a b c ...`; others are ignored. No arrays.
PolygonFile polygons_in_obj(std::string_view text);
/// Parse Geomview OFF: one vertex or face per line; colours are ignored. No arrays.
PolygonFile polygons_in_off(std::string_view text);
/// Parse Stanford PLY, text or binary. Scalar face properties become arrays.
PolygonFile polygons_in_ply(std::string_view bytes);
// Errors: these throw MeshError, naming the line or element, if the text is invalid.

/// Read a file by extension: .obj, .off, .ply; .vtp, .vtu and .vtk with VTK, including arrays with one number per face;
/// .h5, .hdf5 and .hf5 as written by save_datasets of tyssue. Values that are not finite become NaN. FileError if it
/// cannot be read or this build lacks the library; MeshError for other content.
PolygonFile read_polygon_file(const std::filesystem::path& file);

// Readers chosen by read_polygon_file.
PolygonFile read_vtk_polygons(const std::filesystem::path& file);
PolygonFile read_vertex_model(const std::filesystem::path& file);

}  // namespace plica
