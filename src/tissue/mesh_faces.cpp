#include "tissue/mesh_faces.hpp"

#include <algorithm>

#include "tissue/hexahedral_mesh.hpp"

namespace plica {
namespace {

using FaceNodes = std::array<NodeId, 4>;

struct FaceUse {
  FaceNodes sorted_nodes;
  std::int32_t side;  // cell x 6 + face

  auto operator<=>(const FaceUse&) const = default;
};

/// Two cells on either side of a face run round it in opposite directions.
bool opposite(FaceNodes a, const FaceNodes& b) {
  std::reverse(a.begin(), a.end());
  for (int turn = 0; turn < 4; ++turn) {
    if (a == b) return true;
    std::rotate(a.begin(), a.begin() + 1, a.end());
  }
  return false;
}

std::string at_middle(const FaceNodes& face, std::span<const Vec3> points) {
  if (points.empty()) return "";
  Vec3 middle = Vec3::Zero();
  for (const NodeId node : face) middle += points[node.index()] / 4;
  return " at " + place_text(middle);
}

constexpr const char* apical_remedy = "name the cell array that holds each cell's apical face (0-5) as apical_array";

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

/// Pieces of the surface that share no node.
Pieces pieces_of_surface(const HexahedralMesh& mesh, const std::vector<CellFace>& surface) {
  std::vector<std::vector<std::size_t>> sides_at(mesh.points.size());  // nodes
  for (std::size_t s = 0; s < surface.size(); ++s)
    for (int i = 0; i < 4; ++i) sides_at[face_node(mesh, surface[s], i).index()].push_back(s);
  return pieces_of(surface.size(), [&](std::size_t s, const auto& take) {
    for (int i = 0; i < 4; ++i) std::ranges::for_each(sides_at[face_node(mesh, surface[s], i).index()], take);
  });
}

/// The piece of the surface that is the outside of a closed layer. Faces look out of the cells, so the outside encloses
/// a positive volume and the inside, seen from the lumen, a negative one.
std::size_t outer_piece(const HexahedralMesh& mesh, const std::vector<CellFace>& surface, const Pieces& pieces) {
  const Vec3 origin = mesh.points[face_node(mesh, surface.front(), 0).index()];
  std::vector<double> volumes(pieces.sizes.size(), 0.0);
  for (std::size_t s = 0; s < surface.size(); ++s)
    volumes[pieces.piece_of[s]] += enclosed_volume(mesh, surface[s], origin);
  if (volumes.size() == 1)
    throw MeshError(
        "the mesh has a single surface (a block or an open sheet), which leaves its apical faces undetermined; {}",
        apical_remedy);
  if (volumes.size() > 2)
    throw MeshError("the mesh has {} separate surfaces; one closed layer has two: {}", volumes.size(), apical_remedy);
  return volumes[0] > 0 ? 0 : 1;
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

std::array<NodeId, 4> face_nodes(const std::array<NodeId, 8>& cell, int face) {
  std::array<NodeId, 4> nodes;
  for (int i = 0; i < 4; ++i) nodes[i] = cell[hex_faces[face][i]];
  return nodes;
}

MeshFaces::MeshFaces(const std::vector<std::array<NodeId, 8>>& cells, std::span<const Vec3> points)
    : other_side_(cells.size() * 6, -1) {
  std::vector<FaceUse> uses(cells.size() * 6);
  for (std::size_t side = 0; side < uses.size(); ++side) {
    uses[side] = {face_nodes(cells[side / 6], static_cast<int>(side % 6)), static_cast<std::int32_t>(side)};
    std::sort(uses[side].sorted_nodes.begin(), uses[side].sorted_nodes.end());
  }
  std::sort(uses.begin(), uses.end());
  for (std::size_t i = 1; i < uses.size(); ++i) {
    if (uses[i].sorted_nodes != uses[i - 1].sorted_nodes) continue;
    const std::int32_t a = uses[i - 1].side, b = uses[i].side;
    if (other_side_[a] >= 0)
      throw MeshError("cells {}, {} and {} share one face{}; at most two may: remove the one that lies over another",
                      other_side_[a] / 6, a / 6, b / 6, at_middle(uses[i].sorted_nodes, points));
    if (!opposite(face_nodes(cells[a / 6], a % 6), face_nodes(cells[b / 6], b % 6)))
      throw MeshError(
          "cells {} and {} share four nodes{} but do not lie on the two sides of one face: one is twisted, or they "
          "overlap; turn or remove one",
          a / 6, b / 6, at_middle(uses[i].sorted_nodes, points));
    other_side_[a] = b;
    other_side_[b] = a;
  }
}

std::optional<CellFace> MeshFaces::neighbour(const CellFace& side) const {
  const std::int32_t other = other_side_[side.cell * 6 + side.face];
  if (other < 0) return {};
  return CellFace{static_cast<std::size_t>(other / 6), other % 6};
}

std::vector<CellFace> MeshFaces::surface() const {
  std::vector<CellFace> sides;
  for (std::size_t side = 0; side < other_side_.size(); ++side)
    if (other_side_[side] < 0) sides.push_back({side / 6, static_cast<int>(side % 6)});
  return sides;
}

std::vector<int> outer_faces(const HexahedralMesh& mesh, const MeshFaces& faces) {
  const std::vector<CellFace> surface = faces.surface();
  const Pieces pieces = pieces_of_surface(mesh, surface);
  const std::size_t outer = surface.empty() ? 0 : outer_piece(mesh, surface, pieces);

  std::vector<int> apical(mesh.cells.size(), -1);
  for (std::size_t s = 0; s < surface.size(); ++s) {
    const CellFace& side = surface[s];
    if (pieces.piece_of[s] != outer) continue;
    if (apical[side.cell] >= 0)
      throw MeshError("{} has more than one face on the outer surface; a cell has one apical face: {}",
                      cell_at(mesh, side.cell), apical_remedy);
    apical[side.cell] = side.face;
  }
  for (std::size_t cell = 0; cell < apical.size(); ++cell)
    if (apical[cell] < 0)
      throw MeshError("{} has no face on the outer surface; the layer must be one cell thick, or {}",
                      cell_at(mesh, cell), apical_remedy);
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
        throw MeshError(
            "the apical faces of {} and its neighbour, cell {}, do not meet in an edge; correct the array that names "
            "them",
            cell_at(mesh, cell), beyond->cell);
    }
}

}  // namespace plica
