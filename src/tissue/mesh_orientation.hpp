// Which face of each cell of a mesh is apical, and cells turned so that it is where plica wants it.
#pragma once

#include <array>
#include <vector>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/mesh_faces.hpp"

namespace plica {

/// The face of each cell on the outer surface of a closed layer, one cell thick. MeshError when the mesh is no such
/// layer.
std::vector<int> outer_faces(const HexahedralMesh& mesh, const MeshFaces& faces);

/// The cell turned (not mirrored) so that the given face becomes nodes 4-7; face 5 leaves it as it is.
std::array<NodeId, 8> turned_cell(const std::array<NodeId, 8>& cell, int apical_face);

/// MeshError when the apical faces of two neighbours do not fit: side by side, both cells must have the same end of the
/// face they share at their apical side; else neither the layer nor its refinement makes sense.
void check_apical_faces(const HexahedralMesh& mesh, const MeshFaces& faces, const std::vector<int>& apical_faces);

/// The face opposite to a face of a hexahedron.
constexpr int opposite_face(int face) { return face ^ 1; }

}  // namespace plica
