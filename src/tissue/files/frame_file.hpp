// Reading of snapshots of a run, and of surfaces to measure distances to.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/ids.hpp"
#include "core/vector.hpp"

namespace plica {

/// Polygons of cells, as consecutive lists of corners. Files store them as field data of these names with prefix
/// `polygon_`.
struct FramePolygons {
  std::vector<int> ends;           // cells: end of the corners of each
  std::vector<int> apical, basal;  // nodes, counter-clockwise seen from outside, above the apical surface
  std::vector<int> elements;       // cells: first element of each, which has the values of the cell

  [[nodiscard]] bool empty() const { return ends.empty(); }
};

/// Snapshot of a run, as written by write_mesh.
struct Frame {
  Vectors positions;                                           // nodes; um
  std::vector<std::array<NodeId, 8>> elements;                 // VTK's order, nodes 4-7 on the apical side
  std::map<std::string, Vectors> node_vectors;                 // nodes, by name
  std::map<std::string, std::vector<double>> element_scalars;  // elements, by name
  std::optional<double> time_s;
  FramePolygons polygons = {};  // empty if every cell is one element, and in files of older versions

  static auto parts(auto& frame) {
    auto& [ends, apical, basal, elements] = frame.polygons;
    return std::tie(frame.positions, frame.elements, frame.node_vectors, frame.element_scalars, frame.time_s, ends,
                    apical, basal, elements);
  }
};

struct TriangleSurface {
  Vectors points;  // um
  std::vector<std::array<int, 3>> triangles;

  static auto parts(auto& surface) { return std::tie(surface.points, surface.triangles); }
};

/// Read a snapshot: hexahedra, node vectors, one-component cell data and the time. FileError if the file cannot be
/// read, has no hexahedra or contains non-finite numbers; MeshError if it contains other cells.
Frame read_frame(const std::filesystem::path& file);

/// Read the surface in a file (VTK, STL, PLY, OBJ), or the boundary of a volume mesh; polygons are split into
/// triangles. FileError if it cannot be read or has no faces.
TriangleSurface read_surface(const std::filesystem::path& file);

/// Return the times (s) and files of a ParaView collection file, as written by write_collection; paths as in the file.
/// FileError if it cannot be read or is not a collection.
std::vector<std::pair<double, std::string>> read_collection(const std::filesystem::path& pvd);

}  // namespace plica
