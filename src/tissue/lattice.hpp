// From cells to a tissue: each cell is a lattice of nodes, n_u x n_v x n_w elements, and everything else (elements,
// facets, edges) is read off that lattice in the same way for every kind of embryo.
#pragma once

#include <array>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// The nodes of one cell, (n_u + 1)(n_v + 1)(n_w + 1) of them, u fastest. w runs from the basal to the apical face and
/// u x v points outward. `has_apical` and `has_basal` say whether those faces lie on the tissue's surface.
struct CellLattice {
  std::array<int, 3> elements = {1, 1, 1};
  std::vector<NodeId> nodes;
  bool has_apical = true;
  bool has_basal = true;
  std::optional<GridPlace> grid_place;

  [[nodiscard]] NodeId node(int u, int v, int w) const {
    return nodes[u + (elements[0] + 1) * (v + (elements[1] + 1) * w)];
  }
};

/// Numbers the nodes anew, in the order in which the elements come to them. So what a loop over elements looks at lies
/// close together; layer by layer it would be far apart where cells are cut into many elements. Every node has to be
/// one of a cell's.
void number_as_elements_come(std::vector<CellLattice>& cells, Vectors& rest_positions);

/// Appends the cell's elements and facets to the tissue's, with rest shapes from its rest positions, u fastest.
void add_elements_and_facets(const CellLattice& lattice, CellId id, Tissue& tissue);

/// Sets corners, edges and lines of a grid's cell.
void set_corners_and_lines(const CellLattice& lattice, const Vectors& rest_positions, Cell& cell);

/// Builds the tissue of the given cells. Of the directions u and v, a cell's edges along the one that lies closer to x
/// at rest are `along`, the others `across`. Region "all" is set. Takes time in proportion to the elements.
Tissue tissue_from_lattices(const std::vector<CellLattice>& cells, Vectors rest_positions);

}  // namespace plica
