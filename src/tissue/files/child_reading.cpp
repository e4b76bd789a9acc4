#include "tissue/files/child_reading.hpp"

#include <fmt/format.h>

#include "core/bytes.hpp"
#include "core/child_process.hpp"
#include "tissue/hexahedral_mesh.hpp"

namespace plica {

void throw_unread(const std::filesystem::path& file, const std::string& why) {
  throw FileError(fmt::format("{}: cannot be read: {}", file.string(), why));
}

std::string read_in_child(const std::filesystem::path& file, const std::function<std::string()>& read,
                          const char* reader) {
  // A letter for the kind of answer, then what was read or the error.
  const std::optional<std::string> answer = output_of_child("reading " + file.string(), [&] {
    try {
      return 'r' + read();
    } catch (const MeshError& error) {
      return std::string("m") + error.what();
    } catch (const FileError& error) {
      return std::string("f") + error.what();
    }
  });
  if (!answer || answer->empty()) throw_unread(file, fmt::format("it is damaged: {} crashes on it", reader));
  if (answer->front() == 'f') throw FileError(answer->substr(1));
  if (answer->front() == 'm') throw MeshError(answer->substr(1));
  return answer->substr(1);
}

std::string mesh_to_bytes(const HexahedralMesh& mesh) {
  std::string bytes;
  put(mesh.points, bytes);
  put(mesh.cells, bytes);
  put(mesh.apical_faces, bytes);
  const CellGroups& groups = mesh.groups;
  for (const auto* list :
       {&groups.cell_of, &groups.elements_per_cell, &groups.corner_counts, &groups.corners, &groups.hanging})
    put(*list, bytes);
  for (const auto& [name, values] : mesh.arrays) {
    put(name, bytes);
    put(values, bytes);
  }
  return bytes;
}

HexahedralMesh mesh_from_bytes(std::string_view bytes) try {
  HexahedralMesh mesh;
  mesh.points = take<Vectors>(bytes);
  mesh.cells = take<std::vector<std::array<NodeId, 8>>>(bytes);
  mesh.apical_faces = take<std::vector<int>>(bytes);
  CellGroups& groups = mesh.groups;
  for (auto* list :
       {&groups.cell_of, &groups.elements_per_cell, &groups.corner_counts, &groups.corners, &groups.hanging})
    *list = take<std::vector<int>>(bytes);
  while (!bytes.empty()) {
    const auto name = take<std::string>(bytes);
    mesh.arrays[name] = take<CellArray>(bytes);
  }
  return mesh;
} catch (const BytesEndEarly&) {
  throw MeshError("the mesh ends early");
}

}  // namespace plica
