#include "tissue/mesh_faces.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tissue/hexahedral_mesh.hpp"
#include "tissue/place.hpp"

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
      throw MeshError(
          fmt::format("cells {}, {} and {} share one face{}; at most two may: remove the one that lies over another",
                      other_side_[a] / 6, a / 6, b / 6, at_middle(uses[i].sorted_nodes, points)));
    if (!opposite(face_nodes(cells[a / 6], a % 6), face_nodes(cells[b / 6], b % 6)))
      throw MeshError(
          fmt::format("cells {} and {} share four nodes{} but do not lie on the two sides of one face: one is twisted, "
                      "or they overlap; turn or remove one",
                      a / 6, b / 6, at_middle(uses[i].sorted_nodes, points)));
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

}  // namespace plica
