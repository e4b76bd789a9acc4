#include "tissue/files/mesh_bytes.hpp"

#include "core/bytes.hpp"

namespace plica {

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
