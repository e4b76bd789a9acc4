// Meshes read back: the frames of a run, and surfaces to measure distances to.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// The polygons of a mesh's cells, as lists of corners one after the other. Files hold them as field data of these
/// names, with `polygon_` before them.
struct FramePolygons {
  std::vector<int> ends;           // cells: where the cell's corners end among all
  std::vector<int> apical, basal;  // nodes, counter-clockwise seen from outside, above the apex
  std::vector<int> elements;       // cells: the first element of each, whose values are the cell's

  [[nodiscard]] bool empty() const { return ends.empty(); }
};

/// What write_mesh wrote: a moment of a run.
struct Frame {
  Vectors positions;                                           // nodes; um
  std::vector<std::array<NodeId, 8>> elements;                 // VTK's order, nodes 4-7 on the apical side
  std::map<std::string, Vectors> node_vectors;                 // nodes, by name
  std::map<std::string, std::vector<double>> element_scalars;  // elements, by name
  std::optional<double> time_s;
  FramePolygons polygons = {};  // none where every cell is one element, and in frames of older versions
};

/// A surface as flat triangles.
struct TriangleSurface {
  Vectors points;  // um
  std::vector<std::array<int, 3>> triangles;
};

/// Reads a frame: hexahedra, node vectors, one-component cell data and the time. FileError when the file cannot be
/// read, or holds no hexahedra or what is not finite; MeshError when it holds other cells.
Frame read_frame(const std::filesystem::path& file);

/// Reads the surface that a file holds (VTK, STL, PLY, OBJ), or the boundary of a volume mesh; polygons are split into
/// triangles. FileError when it cannot be read or has no face.
TriangleSurface read_surface(const std::filesystem::path& file);

/// The times (s) and files of ParaView's collection file, as write_collection writes it; paths as they stand there.
/// FileError when it cannot be read or is none.
std::vector<std::pair<double, std::string>> read_collection(const std::filesystem::path& pvd);

}  // namespace plica
