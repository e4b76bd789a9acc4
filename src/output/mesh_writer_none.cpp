// What stands in for mesh_writer_vtk.cpp when plica is built without VTK.
#ifndef PLICA_WITH_VTK

#include <fmt/format.h>

#include "core/errors.hpp"
#include "output/mesh_writer.hpp"

namespace plica {

void write_mesh(const std::filesystem::path& file, const Tissue&, std::span<const Vec3>, const MeshArrays&,
                std::optional<double>) {
  throw FileError(fmt::format("{}: cannot be written: plica was built without VTK", file.string()));
}

}  // namespace plica

#endif
