// Hexahedra from a mesh file: checked, oriented and refined into a tissue.
#pragma once

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "tissue/mesh_input.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Cells of several hexahedra, as written by `plica mesh`. The hexahedra of a cell go from basal to apical: nodes 4-7
/// above nodes 0-3, unless `apical_faces` are given.
struct CellGroups {
  std::vector<int> cell_of;  // hexahedra: cell number of each
  std::vector<int>
      elements_per_cell;           // three per cell, the last basal to apical, if all lie on a grid; else empty, and
  std::vector<int> corner_counts;  // cells, by number: corners of both polygons
  std::vector<int> corners;        // points: basal polygon of each cell, then the apical corners above
  std::vector<int> hanging;        // for each of the last points: number of points it is the mean of, and these

  [[nodiscard]] bool is_empty() const { return cell_of.empty(); }
};

/// Return the groups to store with a tissue, so that it can be restored; empty if each hexahedron is a cell of a grid.
CellGroups groups_of(const Tissue& tissue);

struct HexahedralMesh {
  Vectors points;                            // um; unused ones are dropped
  std::vector<std::array<NodeId, 8>> cells;  // VTK order, any face may be apical
  std::vector<int> apical_faces;             // cells; 0-5 in the order of hex_faces. Empty: find the outer surface
  std::map<std::string, CellArray> arrays;   // by name; one number per hexahedron, NaN: no value
  CellGroups groups = {};                    // empty: each hexahedron is a cell
  std::vector<std::string> remarks = {};     // what its reader omitted

  static auto parts(auto& mesh) {
    auto& [cell_of, elements_per_cell, corner_counts, corners, hanging] = mesh.groups;
    return std::tie(mesh.points, mesh.cells, mesh.apical_faces, cell_of, elements_per_cell, corner_counts, corners,
                    hanging, mesh.arrays, mesh.remarks);
  }
};

/// How a mesh becomes a tissue.
struct MeshOptions {
  std::array<int, 3> elements_per_cell = {1, 1, 1};  // along, across, basal to apical
  Placement placement = {};                          // centred on the centroid of its volume
  bool keep_largest = false;                         // of pieces that share no face, keep only the largest
};

/// Largest number of elements of a mesh.
inline constexpr long long largest_mesh_elements = 20'000'000;

/// Make a tissue of a mesh after its placement. With groups, makes their cells, in order of their numbers; arrays that
/// vary within a cell are averaged. Otherwise each hexahedron becomes a cell whose nodes 4-7 are apical, subdivided
/// trilinearly into `elements_per_cell` (along, across, basal to apical) elements; the first two must agree, since
/// cells of a file have no common direction. The volume does not change. Coincident nodes of the surface are merged.
/// Nodes keep their order; those of refined elements follow. Without `apical_faces` the mesh must be one closed layer,
/// one cell thick, whose outer side is apical. MeshError if the mesh is unusable.
Tissue tissue_from_mesh(HexahedralMesh mesh, const MeshOptions& options);

/// Read a hexahedral mesh: VTK unstructured grid, XML (`.vtu`) or legacy (`.vtk`) by content. Every hexahedron is a
/// cell; faces, lines and vertices beside them are omitted.
///
/// Apical is the outer surface of a closed layer, or the face in the cell array `apical_array`, if given: 0-5 in the
/// order of hex_faces. Other one-component cell arrays become `Tissue::cell_arrays`. FileError if the file cannot be
/// read or is another kind of file, MeshError if the mesh is unusable.
Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array, const MeshOptions& options);

// Readers chosen by read_mesh_file.
HexahedralMesh read_vtk_hexahedra(const std::filesystem::path& file, const std::string& apical_array);

/// Make the tissue of a mesh with groups whose hexahedra and points have been checked: grouped_mesh.cpp.
Tissue tissue_from_groups(const HexahedralMesh& mesh);

}  // namespace plica
