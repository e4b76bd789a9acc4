// Orientation of mesh cells: apical face of each, and rotation into the order of plica.
#pragma once

#include <array>
#include <vector>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/mesh_faces.hpp"

namespace plica {

/// Return the face of each cell on the outer surface of a closed layer, one cell thick. MeshError for any other mesh.
std::vector<int> outer_faces(const HexahedralMesh& mesh, const MeshFaces& faces);

/// Return the cell rotated (not mirrored) so that the given face becomes nodes 4-7; unchanged for face 5.
std::array<NodeId, 8> turned_cell(const std::array<NodeId, 8>& cell, int apical_face);

/// Check that apical faces of neighbours meet: both cells must have the same side of their shared face at their apical
/// side. MeshError otherwise.
void check_apical_faces(const HexahedralMesh& mesh, const MeshFaces& faces, const std::vector<int>& apical_faces);

/// Return the face opposite to a face of a hexahedron.
constexpr int opposite_face(int face) { return face ^ 1; }

}  // namespace plica
