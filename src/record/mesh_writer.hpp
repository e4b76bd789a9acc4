// Mesh files in VTK format, for example for ParaView: `.vtu`, `.vtp`, and `.pvd` for a series.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tissue/files/frame_file.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Hexahedra of a mesh with the biological cell of each.
struct MeshElements {
  std::span<const std::array<NodeId, 8>> elements;
  std::span<const CellId> element_cell;  // elements
  std::size_t cells = 0, nodes = 0;

  MeshElements(std::span<const std::array<NodeId, 8>> all, std::span<const CellId> cell_of_each, std::size_t cell_count,
               std::size_t node_count)
      : elements(all), element_cell(cell_of_each), cells(cell_count), nodes(node_count) {}
  MeshElements(const Tissue& tissue)  // NOLINT: implicit conversion intended
      : MeshElements(tissue.elements, tissue.element_cell, tissue.cells.size(), tissue.node_count()) {}
};

/// Named data of a mesh. Cell data have one value per biological cell; the file repeats it for each element of the
/// cell.
struct MeshArrays {
  std::vector<std::pair<std::string, std::span<const Vec3>>> node_vectors;     // nodes
  std::vector<std::pair<std::string, std::vector<double>>> cell_scalars;       // cells
  std::vector<std::pair<std::string, std::vector<int>>> cell_integers;         // cells
  std::vector<std::pair<std::string, std::vector<double>>> node_scalars = {};  // nodes
  std::vector<std::pair<std::string, std::vector<double>>> element_scalars = {};
  const FramePolygons* polygons = nullptr;                           // additional polygons for the file
  std::vector<std::pair<std::string, std::vector<int>>> lists = {};  // field data
};

/// Return the polygons of the cells: corners, and places on their walls where a neighbour was cut, which both cells of
/// a wall have.
FramePolygons polygons_of(const Tissue& tissue);

struct SurfaceMesh {
  Vectors points;                                                    // um
  std::vector<int> ends;                                             // polygons: end of its corners in `corners`
  std::vector<int> corners;                                          // points
  std::vector<std::pair<std::string, std::vector<double>>> scalars;  // polygons
  std::vector<std::pair<std::string, Vectors>> vectors;              // points
  std::optional<double> time_s;
};

/// Write the elements as VTK hexahedra at `positions` (nodes; um) to a `.vtu` file (XML, base64, zlib),
/// atomically. `time_s` becomes field data `TimeValue`. Throws FileError, or std::logic_error for an array of wrong
/// length or with values that are not finite.
void write_mesh(const std::filesystem::path& file, const MeshElements& mesh, std::span<const Vec3> positions,
                const MeshArrays& arrays, std::optional<double> time_s = {});

/// Write a surface to a `.vtp` file, atomically. Throws as write_mesh does.
void write_polygons(const std::filesystem::path& file, const SurfaceMesh& surface);

/// Result of read_frame for the mesh that write_mesh would write, without time.
Frame frame_of(const MeshElements& mesh, std::span<const Vec3> positions, const MeshArrays& arrays);

/// Write ParaView's collection file, atomically: times in s, files relative to its folder. Throws FileError, or
/// std::logic_error for a time that is not finite.
void write_collection(const std::filesystem::path& pvd,
                      const std::vector<std::pair<double, std::string>>& time_and_file);

}  // namespace plica
