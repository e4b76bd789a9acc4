// Reading of external cell meshes.
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Read a hexahedral mesh: VTK unstructured grid, XML (`.vtu`) or legacy (`.vtk`) by content; coordinates in um. Every
/// hexahedron is a cell, subdivided into `elements_per_cell` (along, across, basal to apical) elements.
///
/// Apical is the outer surface of a closed layer, or the face in the cell array `apical_array`, if given: 0-5 in the
/// order of hex_faces. Other one-component cell arrays become `Tissue::cell_arrays`. FileError if the file cannot be
/// read or is another kind of file, MeshError if the mesh is unusable.
Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array,
                      const std::array<int, 3>& elements_per_cell);

}  // namespace plica
