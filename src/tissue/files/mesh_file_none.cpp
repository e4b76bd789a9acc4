// What stands in for mesh_file_vtk.cpp when plica is built without VTK.
#ifndef PLICA_WITH_VTK

#include <fmt/format.h>

#include "core/errors.hpp"
#include "tissue/files/mesh_file.hpp"

namespace plica {

Tissue read_mesh_file(const std::filesystem::path& file, const std::string&, const std::array<int, 3>&) {
  throw FileError(fmt::format("{}: cannot be read: plica was built without VTK", file.string()));
}

}  // namespace plica

#endif
