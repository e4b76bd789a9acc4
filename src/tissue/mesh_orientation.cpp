#include "tissue/mesh_orientation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "tissue/place.hpp"

namespace plica {
namespace {

constexpr const char* apical_remedy = "name the cell array that holds each cell's apical face (0-5) as apical_array";

/// A number of sets of nodes that grow together (union-find).
class NodeSets {
 public:
  explicit NodeSets(std::size_t node_count) : parent_(node_count) { std::iota(parent_.begin(), parent_.end(), 0); }

  std::size_t set_of(std::size_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  /// The set is named after its first node.
  void join(std::size_t a, std::size_t b) {
    const std::size_t set_a = set_of(a), set_b = set_of(b);
    parent_[std::max(set_a, set_b)] = std::min(set_a, set_b);
  }

 private:
  std::vector<std::size_t> parent_;
};

NodeId face_node(const HexahedralMesh& mesh, const CellFace& side, int i) {
  return mesh.cells[side.cell][hex_faces[side.face][i]];
}

/// The face's part of the volume that a closed surface encloses, um^3 (the formula of hexahedron.cpp), from `origin`.
double enclosed_volume(const HexahedralMesh& mesh, const CellFace& side, const Vec3& origin) {
  std::array<Vec3, 4> p;
  for (int i = 0; i < 4; ++i) p[i] = mesh.points[face_node(mesh, side, i).index()] - origin;
  const auto det = [&](int i, int j, int k) { return p[i].dot(p[j].cross(p[k])); };
  return (det(0, 1, 2) + det(0, 2, 3) + det(0, 1, 3) + det(1, 2, 3)) / 12;
}

/// The name (first node) of the component of the surface that is the outside of a closed layer. Faces look out of the
/// cells, so the outside encloses a positive volume and the inside, seen from the lumen, a negative one.
std::size_t outer_component(const HexahedralMesh& mesh, const std::vector<CellFace>& surface, NodeSets& components) {
  const Vec3 origin = mesh.points[face_node(mesh, surface.front(), 0).index()];
  std::map<std::size_t, double> volume;
  for (const CellFace& side : surface)
    volume[components.set_of(face_node(mesh, side, 0).index())] += enclosed_volume(mesh, side, origin);
  if (volume.size() == 1)
    throw MeshError(fmt::format(
        "the mesh has a single surface (a block or an open sheet), which leaves its apical faces undetermined; {}",
        apical_remedy));
  if (volume.size() > 2)
    throw MeshError(
        fmt::format("the mesh has {} separate surfaces; one closed layer has two: {}", volume.size(), apical_remedy));
  const auto [first, first_volume] = *volume.begin();
  const std::size_t second = volume.rbegin()->first;
  return first_volume > 0 ? first : second;
}

/// Nodes of a shared face that are apical in the cell.
std::vector<NodeId> apical_nodes(const HexahedralMesh& mesh, const CellFace& side, int apical_face) {
  std::vector<NodeId> nodes;
  for (const int shared : hex_faces[side.face])
    if (std::count(hex_faces[apical_face].begin(), hex_faces[apical_face].end(), shared) != 0)
      nodes.push_back(mesh.cells[side.cell][shared]);
  std::sort(nodes.begin(), nodes.end());
  return nodes;
}

}  // namespace

std::vector<int> outer_faces(const HexahedralMesh& mesh, const MeshFaces& faces) {
  const std::vector<CellFace> surface = faces.surface();
  NodeSets components(mesh.points.size());
  for (const CellFace& side : surface)
    for (int i = 1; i < 4; ++i) components.join(face_node(mesh, side, 0).index(), face_node(mesh, side, i).index());
  const std::size_t outer = surface.empty() ? 0 : outer_component(mesh, surface, components);

  std::vector<int> apical(mesh.cells.size(), -1);
  for (const CellFace& side : surface) {
    if (components.set_of(face_node(mesh, side, 0).index()) != outer) continue;
    if (apical[side.cell] >= 0)
      throw MeshError(fmt::format("{} has more than one face on the outer surface; a cell has one apical face: {}",
                                  cell_at(mesh, side.cell), apical_remedy));
    apical[side.cell] = side.face;
  }
  for (std::size_t cell = 0; cell < apical.size(); ++cell)
    if (apical[cell] < 0)
      throw MeshError(fmt::format("{} has no face on the outer surface; the layer must be one cell thick, or {}",
                                  cell_at(mesh, cell), apical_remedy));
  return apical;
}

std::array<NodeId, 8> turned_cell(const std::array<NodeId, 8>& cell, int apical_face) {
  // A face runs counter-clockwise seen from outside, as nodes 4-7 do seen from above. Below each node lies the one at
  // the other end of its edge out of the face.
  const std::array<int, 4>& top = hex_faces[apical_face];
  const auto in_top = [&](int node) { return std::find(top.begin(), top.end(), node) != top.end(); };
  std::array<NodeId, 8> turned;
  for (int i = 0; i < 4; ++i) {
    turned[4 + i] = cell[top[i]];
    for (const auto& [a, b] : hex_edges) {
      if (a == top[i] && !in_top(b)) turned[i] = cell[b];
      if (b == top[i] && !in_top(a)) turned[i] = cell[a];
    }
  }
  return turned;
}

void check_apical_faces(const HexahedralMesh& mesh, const MeshFaces& faces, const std::vector<int>& apical_faces) {
  for (std::size_t cell = 0; cell < mesh.cells.size(); ++cell)
    for (int face = 0; face < 6; ++face) {
      const auto beyond = faces.neighbour({cell, face});
      if (!beyond || beyond->cell < cell) continue;
      const auto here = apical_nodes(mesh, {cell, face}, apical_faces[cell]);
      const auto there = apical_nodes(mesh, *beyond, apical_faces[beyond->cell]);
      // Two of the nodes: a lateral face. Four or none: an apical or basal face, on which cells may be stacked.
      const bool stacked = here.size() != 2 && there.size() != 2;
      if (!stacked && here != there)
        throw MeshError(fmt::format(
            "the apical faces of {} and its neighbour, cell {}, do not meet in an edge; correct the array that "
            "names them",
            cell_at(mesh, cell), beyond->cell));
    }
}

}  // namespace plica
