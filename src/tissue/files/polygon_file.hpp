// Reading of polygon surfaces, one face per cell, from modelling software, image tools and vertex models.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <tuple>

#include "tissue/shapes/polygon_surface.hpp"
#include "tissue/tissue.hpp"

namespace plica {

struct PolygonFile {
  PolygonSurface surface;                   // as in the file: unchecked, but corners are existing vertices
  std::map<std::string, CellArray> arrays;  // one number per face; NaN: no value
  std::vector<std::string> remarks = {};    // what was corrected or omitted

  static auto parts(auto& file) {
    return std::tie(file.surface.vertices, file.surface.polygons, file.arrays, file.remarks);
  }
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

/// Table as in pandas: an index number per row, and named numeric columns.
struct NumberedTable {
  std::vector<double> index;
  std::map<std::string, std::vector<double>> columns;
};

struct VertexModelTables {
  NumberedTable vertices;  // x, y and optionally z
  NumberedTable edges;     // half-edges along the outlines of faces: srce, trgt, face
  NumberedTable faces;     // any columns

  static auto parts(auto& tables) {
    auto& [vertices, edges, faces] = tables;
    return std::tie(vertices.index, vertices.columns, edges.index, edges.columns, faces.index, faces.columns);
  }
};

/// Return faces in the order of their table, with its columns as arrays; faces without edges are omitted. MeshError if
/// columns or referenced rows are missing, or the edges of a face do not form one ring. Edges of a ring that run
/// against most others are reversed.
PolygonFile polygons_of(const VertexModelTables& tables);

/// Join the faces of each label to one polygon, in order of labels; faces with label 0, less or NaN belong to no cell.
/// Its corners are the vertices where three cells, or two and the outside, meet. Arrays become means over the faces.
/// Cells with fewer than three corners are omitted, with a remark. MeshError if the file has no array of this name, a
/// cell is in pieces or has a hole, or none is left.
PolygonFile cells_of_labels(const PolygonFile& file, const std::string& label_array);

/// Return advice to name a label array, if all faces are triangles and an array numbers groups of them; else nothing.
std::string label_advice(const PolygonFile& file);

}  // namespace plica
