// Reading by libraries that a damaged file may crash: in a child process, which hands over what it found as bytes.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace plica {

/// FileError: `FILE: cannot be read: WHY`.
[[noreturn]] void throw_unread(const std::filesystem::path& file, const std::string& why);

/// What `read` returns, run in a child process. Its FileError and MeshError come out here; FileError when it crashed,
/// which says that `reader` (a library's name) breaks off at the file.
std::string read_in_child(const std::filesystem::path& file, const std::function<std::string()>& read,
                          const char* reader = "VTK");

}  // namespace plica
