// Reading of external cell meshes.
#pragma once

#include <filesystem>
#include <string>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Read a hexahedral mesh: VTK unstructured grid, XML (`.vtu`) or legacy (`.vtk`) by content. Every hexahedron is a
/// cell; faces, lines and vertices beside them are omitted.
///
/// Apical is the outer surface of a closed layer, or the face in the cell array `apical_array`, if given: 0-5 in the
/// order of hex_faces. Other one-component cell arrays become `Tissue::cell_arrays`. FileError if the file cannot be
/// read or is another kind of file, MeshError if the mesh is unusable.
Tissue read_mesh_file(const std::filesystem::path& file, const std::string& apical_array, const MeshOptions& options);

}  // namespace plica
