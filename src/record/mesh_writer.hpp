// Meshes for ParaView and other readers of VTK's files: `.vtu`, and `.pvd` for a series of them.
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

/// The hexahedra of a mesh, and the plica cell of each.
struct MeshElements {
  std::span<const std::array<NodeId, 8>> elements;
  std::span<const CellId> element_cell;  // elements
  std::size_t cells = 0, nodes = 0;

  MeshElements(std::span<const std::array<NodeId, 8>> all, std::span<const CellId> cell_of_each, std::size_t cell_count,
               std::size_t node_count)
      : elements(all), element_cell(cell_of_each), cells(cell_count), nodes(node_count) {}
  MeshElements(const Tissue& tissue)  // NOLINT: meant to convert
      : MeshElements(tissue.elements, tissue.element_cell, tissue.cells.size(), tissue.node_count()) {}
};

/// Named data of a mesh. Cell values are one a plica cell; the file repeats them for each element of the cell.
struct MeshArrays {
  std::vector<std::pair<std::string, std::span<const Vec3>>> node_vectors;     // nodes
  std::vector<std::pair<std::string, std::vector<double>>> cell_scalars;       // cells
  std::vector<std::pair<std::string, std::vector<int>>> cell_integers;         // cells
  std::vector<std::pair<std::string, std::vector<double>>> node_scalars = {};  // nodes
  std::vector<std::pair<std::string, std::vector<double>>> element_scalars = {};
  const FramePolygons* polygons = nullptr;                           // that the file is to hold besides
  std::vector<std::pair<std::string, std::vector<int>>> lists = {};  // of the whole: field data
};

FramePolygons polygons_of(const Tissue& tissue);

/// A surface of polygons with numbers for each.
struct SurfaceMesh {
  Vectors points;                                                    // um
  std::vector<int> ends;                                             // polygons: where its corners end among all
  std::vector<int> corners;                                          // points
  std::vector<std::pair<std::string, std::vector<double>>> scalars;  // polygons
  std::vector<std::pair<std::string, Vectors>> vectors;              // points
  std::optional<double> time_s;
};

/// Writes the elements as VTK hexahedra at `positions` (nodes; um) to a `.vtu` file: VTK's XML format, appended raw
/// data, compressed as by zlib. Whole or not at all. With `time_s` the file carries it as field data `TimeValue`.
/// FileError when the file cannot be written. std::logic_error when an array has the wrong length or holds what is not
/// finite: a NaN never reaches a file.
void write_mesh(const std::filesystem::path& file, const MeshElements& mesh, std::span<const Vec3> positions,
                const MeshArrays& arrays, std::optional<double> time_s = {});

/// Writes a surface to a `.vtp` file; whole or not at all, and with the same errors.
void write_polygons(const std::filesystem::path& file, const SurfaceMesh& surface);

/// What read_frame gives back of the mesh that write_mesh writes, but for its time.
Frame frame_of(const MeshElements& mesh, std::span<const Vec3> positions, const MeshArrays& arrays);

/// Writes ParaView's collection file: times in s, and files relative to the collection's folder. Whole or not at all.
/// FileError when it cannot be written, std::logic_error when a time is not finite.
void write_collection(const std::filesystem::path& pvd,
                      const std::vector<std::pair<double, std::string>>& time_and_file);

}  // namespace plica
