// Faces of a hexahedral mesh: adjacency, surface, and the apical face of each cell, which orients it.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "tissue/mesh_input.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Face of a cell, 0-5 in the order of hex_faces.
struct CellFace {
  std::size_t cell;
  int face;
};

/// Return the nodes of a face of a cell, counter-clockwise seen from outside.
std::array<NodeId, 4> face_nodes(const std::array<NodeId, 8>& cell, int face);

class MeshFaces {
 public:
  /// Pair the faces of cells in VTK order. MeshError if more than two cells share a face, or if two share its nodes but
  /// not the face (twisted or overlapping). With `points`, the message has positions.
  explicit MeshFaces(const std::vector<std::array<NodeId, 8>>& cells, std::span<const Vec3> points = {});

  /// Return the face as seen by the adjacent cell; empty on the surface.
  [[nodiscard]] std::optional<CellFace> neighbour(const CellFace& side) const;
  [[nodiscard]] bool on_surface(const CellFace& side) const { return !neighbour(side); }

  /// Return the faces of one cell only, in order of cells.
  [[nodiscard]] std::vector<CellFace> surface() const;

 private:
  std::vector<std::int32_t> other_side_;  // cells x 6: cell x 6 + face beyond, or -1
};

/// Return the face of each cell on the outer surface of a closed layer, one cell thick. MeshError for any other mesh.
std::vector<int> outer_faces(const HexahedralMesh& mesh, const MeshFaces& faces);

/// Return the cell rotated (not mirrored) so that the given face becomes nodes 4-7; unchanged for face 5.
std::array<NodeId, 8> turned_cell(const std::array<NodeId, 8>& cell, int apical_face);

/// Check that apical faces of neighbours meet: both cells must have the same side of their shared face at their apical
/// side. MeshError otherwise.
void check_apical_faces(const HexahedralMesh& mesh, const MeshFaces& faces, const std::vector<int>& apical_faces);

constexpr int opposite_face(int face) { return face ^ 1; }

}  // namespace plica
