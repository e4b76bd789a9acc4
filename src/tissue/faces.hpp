// The faces of a tissue as laws on faces are told them: apical, basal, and lateral ones, each of these once.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// A bilinear face, counter-clockwise seen from outside its cell.
struct Face {
  std::array<NodeId, 4> nodes;
  CellId cell;
  std::optional<CellId> beyond;  // of a lateral face: the neighbour, which shares it; none at a rim
  double share = 1;              // how much of it is this tissue's: a half on a mirror plane, or at an end of a slice
};

/// All faces of a side, in the order of the elements. A cell of several elements has several on each side. A lateral
/// face stands once, for the first of its two cells. After a division a wall is cut where the neighbour has been, so
/// that each face has one cell on either side.
std::vector<Face> faces_of(const Tissue& tissue, CellSide side);

/// The rim of a surface of facets, none of a closed one: edges that two facets do not share, between free nodes, as the
/// facet has them. Where nodes hang on a facet's edge and its neighbour's edges end at them, these are shared.
std::vector<std::pair<NodeId, NodeId>> rim_of(const Tissue& tissue, std::span<const Facet> facets);

/// Whether a surface of facets encloses a volume: it has no rim, and does not go on for ever either.
bool encloses(const Tissue& tissue, std::span<const Facet> facets);

/// The cells that share a wall with each cell, in the order of their numbers.
std::vector<std::vector<CellId>> wall_neighbours(const Tissue& tissue);

/// The first cell that lacks an apical or a basal face: there is more than one layer of cells.
std::optional<CellId> cell_between_layers(const Tissue& tissue);

}  // namespace plica
