// Substitutes for frame_file_vtk.cpp and mesh_file_vtk.cpp when plica is built without VTK,
// and for vertex_model_hdf5.cpp when it is built without HDF5.
#include <fmt/format.h>

#include "core/errors.hpp"
#include "tissue/files/frame_file.hpp"
#include "tissue/files/polygon_file.hpp"
#include "tissue/hexahedral_mesh.hpp"

#ifndef PLICA_WITH_VTK

namespace plica {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file) {
  throw FileError(
      fmt::format("{}: cannot be read: this build has no VTK; build plica with VTK, or read the file from Python "
                  "through meshio: pip install 'plica[plot]'",
                  file.string()));
}

}  // namespace

Frame read_frame(const std::filesystem::path& file) { refuse(file); }
HexahedralMesh read_vtk_hexahedra(const std::filesystem::path& file, const std::string&) { refuse(file); }
TriangleSurface read_surface(const std::filesystem::path& file) { refuse(file); }
std::vector<std::pair<double, std::string>> read_collection(const std::filesystem::path& pvd) { refuse(pvd); }
PolygonFile read_vtk_polygons(const std::filesystem::path& file) {
  throw FileError(fmt::format(
      "{}: cannot be read: this build has no VTK; build plica with VTK, or save the surface as OBJ, OFF or PLY",
      file.string()));
}

}  // namespace plica

#endif

#ifndef PLICA_WITH_HDF5

plica::PolygonFile plica::read_vertex_model(const std::filesystem::path& file) {
  throw FileError(fmt::format(
      "{}: cannot be read: this build has no HDF5; build plica with HDF5, or save the surface as OBJ", file.string()));
}

#endif
