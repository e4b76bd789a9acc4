// A mesh as a string of bytes, to hand it from one process to another on the same machine.
#pragma once

#include <string>
#include <string_view>

#include "tissue/hexahedral_mesh.hpp"

namespace plica {

std::string mesh_to_bytes(const HexahedralMesh& mesh);

/// MeshError when the bytes end early.
HexahedralMesh mesh_from_bytes(std::string_view bytes);

}  // namespace plica
