// What stands in for frame_file_vtk.cpp and mesh_file_vtk.cpp when plica is built without VTK.
#ifndef PLICA_WITH_VTK

#include <fmt/format.h>

#include "core/errors.hpp"
#include "tissue/files/frame_file.hpp"
#include "tissue/files/mesh_file.hpp"

namespace plica {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw FileError(
      fmt::format("{}: cannot be read: this plica was built without VTK. Build it with VTK, or read the "
                  "file from Python, which takes meshio for it: pip install 'plica[plot]'",
                  file.string()));
}

}  // namespace

Frame read_frame(const std::filesystem::path& file) { refuse(file); }
Tissue read_mesh_file(const std::filesystem::path& file, const std::string&, const std::array<int, 3>&) {
  refuse(file);
}
TriangleSurface read_surface(const std::filesystem::path& file) { refuse(file); }
std::vector<std::pair<double, std::string>> read_collection(const std::filesystem::path& pvd) { refuse(pvd); }

}  // namespace plica

#endif
