// Meshes of cells made elsewhere.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Reads a hexahedral mesh: VTK's unstructured grid, XML (`.vtu`) or legacy (`.vtk`), told by its content; coordinates
/// in um. Every hexahedron is a cell, subdivided into `elements_per_cell` (along, across, basal to apical) elements.
///
/// Apical is the outer surface of a closed layer, or the face that the cell array `apical_array` names when it is not
/// empty: 0-5 in the order of hex_faces. Every other cell array of one component becomes one of `Tissue::cell_arrays`.
/// FileError when the file cannot be read or is no such mesh, MeshError when the mesh cannot be used.
Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array,
                      const std::array<int, 3>& elements_per_cell);

}  // namespace plica
