// Hexahedra as a mesh file gives them, checked, turned the right way up and refined into a tissue.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "core/errors.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// A mesh that cannot be used, as good as a file that cannot be read. The text says which cell and what is wrong with
/// it, without the file's name unless it comes from read_mesh_file or read_frame.
class MeshError : public FileError {
 public:
  using FileError::FileError;
};

struct HexahedralMesh {
  Vectors points;                            // um; those that no cell uses are dropped
  std::vector<std::array<NodeId, 8>> cells;  // VTK's order, any face may be the apical one
  std::vector<int> apical_faces;             // cells; 0-5 in the order of hex_faces. Empty: find the outer surface
  std::map<std::string, CellArray> arrays;   // named; a number a cell
};

/// Largest number of elements of a mesh.
inline constexpr long long largest_mesh_elements = 20'000'000;

/// Makes every hexahedron a cell whose nodes 4-7 are apical, subdivided trilinearly into `elements_per_cell` (along,
/// across, basal to apical) elements; the first two must agree, since a file's cells have no common direction. The
/// volume does not change. Nodes keep their order, those of refined elements follow. Without `apical_faces` the mesh
/// must be one closed layer, one cell thick, and apical is outside. MeshError when the mesh cannot be used.
Tissue tissue_from_mesh(const HexahedralMesh& mesh, const std::array<int, 3>& elements_per_cell);

}  // namespace plica
