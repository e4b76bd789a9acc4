// Tissue from lattices: each cell is a lattice of nodes, n_u x n_v x n_w elements; elements, facets and edges are
// derived from it in the same way for every shape.
#pragma once

#include <array>
#include <vector>

#include "tissue/tissue.hpp"

namespace plica {

/// Lattice of a cell: (n_u + 1)(n_v + 1)(n_w + 1) nodes, u fastest. w runs from the basal to the apical face and u x v
/// points outward. `has_apical` and `has_basal`: whether those faces lie on the surface of the tissue.
struct CellLattice {
  std::array<int, 3> elements = {1, 1, 1};
  std::vector<NodeId> nodes;
  bool has_apical = true;
  bool has_basal = true;
  std::optional<GridPlace> grid_place;

  /// Append all nodes, node_at(u, v, w).
  template <class NodeAt>
  void add_nodes(const NodeAt& node_at) {
    for (int w = 0; w <= elements[2]; ++w)
      for (int v = 0; v <= elements[1]; ++v)
        for (int u = 0; u <= elements[0]; ++u) nodes.emplace_back(node_at(u, v, w));
  }

  [[nodiscard]] NodeId node(int u, int v, int w) const {
    return nodes[u + (elements[0] + 1) * (v + (elements[1] + 1) * w)];
  }
};

/// Set corners, edges and lines of a grid cell.
void set_corners_and_lines(const CellLattice& lattice, const Vectors& rest_positions, Cell& cell);

/// Build the tissue of the given cells. Of directions u and v, edges closer to x in the reference state are `along`,
/// the others `across`. Sets region "all". Takes linear time.
Tissue tissue_from_lattices(const std::vector<CellLattice>& cells, Vectors rest_positions);

}  // namespace plica
