// Serialisation of a mesh, to pass it between processes on one machine.
#pragma once

#include <string>
#include <string_view>

#include "tissue/hexahedral_mesh.hpp"

namespace plica {

std::string mesh_to_bytes(const HexahedralMesh& mesh);

/// Read a mesh back. MeshError if the bytes end early.
HexahedralMesh mesh_from_bytes(std::string_view bytes);

}  // namespace plica
