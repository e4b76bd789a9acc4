// Cells that are meshed again, since their rings change or their elements are bad: splits, rest shapes, meshes.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "tissue/tissue_change.hpp"

namespace plica {

/// Return the free nodes of a vertex, from base to apex: of its original, if it is an image.
const std::vector<NodeId>& column(const Sheet& sheet, VertexId vertex);

/// Return the distance of a vertex from its original, um.
Vec3 shift_of(const Tissue& tissue, VertexId vertex);

/// Return the place of a vertex on a level, 0 at the base, given positions of free nodes.
Vec3 place_of(const Tissue& tissue, VertexId vertex, std::size_t level, std::span<const Vec3> positions);

/// Map from the present shape of a cell to its rest shape.
using Unstretch = std::function<Mat3(CellId)>;

/// Gives cells new rings, in a sheet whose mesh is made afterwards (complete_remeshed).
class Remesher {
 public:
  /// All must outlive it. `positions`: of free nodes at least, um.
  Remesher(Tissue& tissue, Vectors& positions, const Unstretch& unstretch);

  /// Remember these cells and columns, so that they can be restored.
  void begin(std::span<const CellId> cells, std::span<const VertexId> columns);
  /// Make all stops of these cells corners, and split them in the best way at present and in the rest shape. If
  /// elements are bad, restore what begin remembers, and return false.
  bool finish();

  /// Return the image of a vertex so many periods away, made if it is missing.
  VertexId image(VertexId original, const std::array<int, 3>& periods);

 private:
  bool take_split(CellId cell);

  Tissue& tissue_;
  Sheet& sheet_;
  Vectors& positions_;
  const Unstretch& unstretch_;
  std::vector<std::pair<CellId, Polygon>> polygons_;
  std::vector<std::pair<NodeId, Vec3>> places_;
};

/// Return the rest volumes of cells, um^3.
std::vector<double> rest_volumes(const Tissue& tissue);

/// Mesh a tissue some of whose cells are remeshed (TissueChange::remeshed). Their rest shapes are the present ones,
/// mapped, with rest volumes as `volumes` (former cells) has them. Rest shapes of other cells stay.
void complete_remeshed(Tissue& tissue, const TissueChange& change, const Unstretch& unstretch,
                       const std::vector<double>& volumes, Vectors& positions);

/// Return the cells with a bad element.
std::vector<CellId> badly_split(const Tissue& tissue, std::span<const Vec3> positions);

/// Whether the worst element of a cell would become at least twice as good if it was split again.
bool gains_by_split(const Tissue& tissue, CellId cell, std::span<const Vec3> positions, const Unstretch& unstretch);

/// Split cells again, in the best way. Their stops become corners; rest shapes are as in turn_walls, positions stay.
TissueChange split_again(Tissue& tissue, std::span<const CellId> cells, Vectors& positions, const Unstretch& unstretch);

}  // namespace plica
