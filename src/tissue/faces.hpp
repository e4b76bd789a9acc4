// Faces of a tissue for laws on faces: apical, basal, and lateral ones, each lateral face once; and what follows from
// them: neighbours, rows and rings of cells, whether a surface is closed.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tissue/hexahedron.hpp"
#include "tissue/tissue.hpp"

namespace plica {

/// Bilinear face, counter-clockwise seen from outside its cell; a lateral one begins at the base.
struct Face {
  std::array<NodeId, 4> nodes;
  CellId cell;
  std::optional<CellId> beyond;  // lateral face: the neighbour that shares it; none at a boundary
  double share = 1;              // fraction of this tissue: 1/2 on a mirror plane or at an end of a slice
};

/// Return all faces of a side, in order of elements. A cell of several elements has several on each side. A lateral
/// face occurs once, for the first of its two cells. After a division a lateral face is cut where the neighbour was, so
/// that each face has one cell on either side.
std::vector<Face> faces_of(const Tissue& tissue, CellSide side);

/// Return the boundary of a surface of facets (empty if closed): edges between free nodes that belong to one facet,
/// oriented as in it. Edges of neighbours that end at nodes hanging on an edge of a facet are shared.
std::vector<std::pair<NodeId, NodeId>> rim_of(const Tissue& tissue, std::span<const Facet> facets);

/// Whether a surface of facets encloses a volume: it has no boundary and is not periodic.
bool encloses(const Tissue& tissue, std::span<const Facet> facets);

/// Whether the tissue goes round its axis x, so that places across it are arcs: a slice, or a tissue that is closed,
/// whose apical surface encloses a volume. Independent of a vitelline membrane.
bool goes_round(const Tissue& tissue);

/// Return the cells that share a lateral face with each cell, ascending.
std::vector<std::vector<CellId>> wall_neighbours(const Tissue& tissue);

/// Return the fraction of a wall of a cell, by the stop of its ring where it begins, that belongs to this tissue.
double wall_share(const Tissue& tissue, CellId cell, std::size_t stop);

/// Return the neighbours of each cell by wall_neighbours, and for each side of a cell on a mirror plane or at an end of
/// a slice its image, which is the cell itself; itself, too, if it has no neighbour.
std::vector<std::vector<CellId>> neighbours_and_images(const Tissue& tissue);

/// Return the first cell without an apical or basal face, which shows more than one layer of cells.
std::optional<CellId> cell_between_layers(const Tissue& tissue);

/// Return the height in a cell of the mean of these nodes, reference state: 0 at the basal, 100 at the apical surface.
double height_percent(const Tissue& tissue, CellId cell, std::span<const NodeId> nodes);

/// Return twice the distance of each cell from the ventral midline, counted in cells along the shortest path through
/// lateral faces: 0, 2, 4, ... if cells lie on the midline, 1, 3, 5, ... if it runs between two rows; -1 if
/// unreachable. The midline is where the plane y = 0 cuts the apical surface, towards -z if the tissue has an outer
/// shape.
std::vector<int> half_cells_from_midline(const Tissue& tissue);

/// Return the cells outside of a set within a number of lateral faces from it.
CellSet cells_around(const Tissue& tissue, const CellSet& cells, int rings);

/// Sum over the facets of a surface, for whether it faces one way: an open sheet, in contrast to a closed surface or a
/// tube.
struct Facing {
  Vec3 area_vectors = Vec3::Zero();
  double area = 0;

  void add(const std::array<Vec3, 4>& facet) {
    const Vec3 vector = facet_area_vector(facet);
    area_vectors += vector;
    area += vector.norm();
  }

  /// |Sum of area vectors| / sum of areas is 0 for a closed surface and 1 for a flat one.
  [[nodiscard]] bool is_one_way() const { return area_vectors.norm() > 0.2 * area; }
};

}  // namespace plica
