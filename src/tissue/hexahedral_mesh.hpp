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

/// Cells of several hexahedra, as `plica mesh` writes them. A cell's hexahedra go from basal to apical: nodes 4-7 of
/// each lie above its nodes 0-3, unless `apical_faces` say otherwise.
struct CellGroups {
  std::vector<int> cell_of;  // hexahedra: the number of the cell that each belongs to
  std::vector<int>
      elements_per_cell;           // three a cell, the last basal to apical, where all lie on a grid; else empty, and
  std::vector<int> corner_counts;  // cells, by number: corners of both polygons
  std::vector<int> corners;        // points: of each cell those of the basal polygon, then those above them
  std::vector<int> hanging;        // of each of the last points: how many it lies in the middle of, and which

  [[nodiscard]] bool is_empty() const { return cell_of.empty(); }
};

/// What a tissue's file has to say, so that it comes back as it was; nothing where each hexahedron is a cell of a grid.
CellGroups groups_of(const Tissue& tissue);

struct HexahedralMesh {
  Vectors points;                            // um; those that no cell uses are dropped
  std::vector<std::array<NodeId, 8>> cells;  // VTK's order, any face may be the apical one
  std::vector<int> apical_faces;             // cells; 0-5 in the order of hex_faces. Empty: find the outer surface
  std::map<std::string, CellArray> arrays;   // named; a number a hexahedron
  CellGroups groups = {};                    // empty: each hexahedron is a cell
};

/// Largest number of elements of a mesh.
inline constexpr long long largest_mesh_elements = 20'000'000;

/// With groups, makes their cells, in the order of their numbers; numbers of an array that differ within a cell are
/// averaged. Else makes every hexahedron a cell whose nodes 4-7 are apical, subdivided trilinearly into
/// `elements_per_cell` (along, across, basal to apical) elements; the first two must agree, since a file's cells have
/// no common direction. The volume does not change. Nodes keep their order, those of refined elements follow. Without
/// `apical_faces` the mesh must be one closed layer, one cell thick, and apical is outside. MeshError when the mesh
/// cannot be used.
Tissue tissue_from_mesh(const HexahedralMesh& mesh, const std::array<int, 3>& elements_per_cell);

/// The same of a mesh with groups whose hexahedra and points have been checked: grouped_mesh.cpp.
Tissue tissue_from_groups(const HexahedralMesh& mesh);

}  // namespace plica
