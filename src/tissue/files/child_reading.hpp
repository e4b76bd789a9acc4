// File reading in a child process, for libraries that damaged files may crash; results are passed as bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "tissue/hexahedral_mesh.hpp"

namespace plica {

/// Throw FileError `FILE: cannot be read: WHY`.
[[noreturn]] void throw_unread(const std::filesystem::path& file, const std::string& why);

/// Return the result of `read`, run in a child process. Its FileError and MeshError are passed on; FileError if it
/// crashed, naming the library `reader`.
std::string read_in_child(const std::filesystem::path& file, const std::function<std::string()>& read,
                          const char* reader = "VTK");

std::string mesh_to_bytes(const HexahedralMesh& mesh);

/// Read a mesh back. MeshError if the bytes end early.
HexahedralMesh mesh_from_bytes(std::string_view bytes);

}  // namespace plica
