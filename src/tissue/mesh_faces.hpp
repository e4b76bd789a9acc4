// Which cells of a hexahedral mesh share a face, and which faces are its surface.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// A face of a cell, 0-5 in the order of hex_faces.
struct CellFace {
  std::size_t cell;
  int face;
};

/// The nodes of a face of a cell, counter-clockwise seen from outside.
std::array<NodeId, 4> face_nodes(const std::array<NodeId, 8>& cell, int face);

class MeshFaces {
 public:
  /// Pairs the faces of cells in VTK's order. MeshError when more than two cells share a face, or when two share its
  /// nodes but not the face: twisted, or lying over each other. It says where, if `points` are given.
  explicit MeshFaces(const std::vector<std::array<NodeId, 8>>& cells, std::span<const Vec3> points = {});

  /// The same face as the cell beyond it has it; nothing on the surface.
  [[nodiscard]] std::optional<CellFace> neighbour(const CellFace& side) const;
  [[nodiscard]] bool on_surface(const CellFace& side) const { return !neighbour(side); }

  /// The faces used by one cell only, in the order of the cells.
  [[nodiscard]] std::vector<CellFace> surface() const;

 private:
  std::vector<std::int32_t> other_side_;  // cells x 6: cell x 6 + face beyond, or -1
};

}  // namespace plica
