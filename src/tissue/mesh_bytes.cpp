#include "tissue/mesh_bytes.hpp"

#include <cstring>

namespace plica {
namespace {

/// Appends the length and the items of a vector or string.
template <class Items>
void put(const Items& items, std::string& bytes) {
  const std::size_t count = items.size();
  bytes.append(reinterpret_cast<const char*>(&count), sizeof count);
  bytes.append(reinterpret_cast<const char*>(items.data()), count * sizeof(typename Items::value_type));
}

/// Takes what `put` appended off the front.
template <class Items>
Items take(std::string_view& bytes) {
  std::size_t count = 0;
  constexpr std::size_t item_size = sizeof(typename Items::value_type);
  const auto need = [&](bool there) {
    if (!there) throw MeshError("the mesh ends early");
  };
  need(bytes.size() >= sizeof count);
  std::memcpy(&count, bytes.data(), sizeof count);
  bytes.remove_prefix(sizeof count);
  need(count <= bytes.size() / item_size);
  Items items;
  items.resize(count);
  if (count > 0) std::memcpy(static_cast<void*>(items.data()), bytes.data(), count * item_size);
  bytes.remove_prefix(count * item_size);
  return items;
}

}  // namespace

std::string mesh_to_bytes(const HexahedralMesh& mesh) {
  std::string bytes;
  put(mesh.points, bytes);
  put(mesh.cells, bytes);
  put(mesh.apical_faces, bytes);
  for (const auto& [name, set] : mesh.arrays) {
    put(name, bytes);
    put(std::string(set.begin(), set.end()), bytes);
  }
  return bytes;
}

HexahedralMesh mesh_from_bytes(std::string_view bytes) {
  HexahedralMesh mesh;
  mesh.points = take<Vectors>(bytes);
  mesh.cells = take<std::vector<std::array<NodeId, 8>>>(bytes);
  mesh.apical_faces = take<std::vector<int>>(bytes);
  while (!bytes.empty()) {
    const auto name = take<std::string>(bytes), flags = take<std::string>(bytes);
    mesh.arrays[name] = CellSet(flags.begin(), flags.end());
  }
  return mesh;
}

}  // namespace plica
