#include "tissue/inner_nodes.hpp"

namespace plica {

std::vector<bool> inner_nodes_of_polygons(const Tissue& tissue) {
  std::vector<bool> is_inner(tissue.node_count(), false);
  for (const auto* facets : {&tissue.basal_facets, &tissue.apical_facets})
    for (const Facet& facet : *facets)
      for (const NodeId node : facet.nodes)
        if (node.index() < tissue.free_node_count() && !tissue.cells[facet.cell.index()].is_of_grid)
          is_inner[node.index()] = true;
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges)
      for (const NodeId node : edge.nodes) is_inner[node.index()] = false;
  return is_inner;
}

}  // namespace plica
