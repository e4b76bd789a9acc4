#include "tissue/part.hpp"

namespace plica {

Division keep_only(Tissue& tissue, const CellSet& cells) {
  Division division;
  division.free_nodes_before = tissue.free_node_count();
  std::vector<CellId> place(tissue.cells.size());          // of cells that stay
  std::vector<ElementId> element(tissue.elements.size());  // of elements that stay
  Tissue part = tissue;
  part.cells.clear();
  part.elements.clear();
  part.element_cell.clear();
  part.element_rest_shape.clear();
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    if (!cells[c]) continue;
    place[c] = CellId(part.cells.size());
    division.origin.emplace_back(c);
    part.cells.push_back(tissue.cells[c]);
    part.cells.back().first_element = ElementId(part.elements.size());
    const std::size_t first = tissue.cells[c].first_element.index();
    for (std::size_t e = first; e < first + tissue.cells[c].element_count; ++e) {
      element[e] = ElementId(part.elements.size());
      part.elements.push_back(tissue.elements[e]);
      part.element_cell.push_back(place[c]);
      part.element_rest_shape.push_back(tissue.element_rest_shape[e]);
    }
  }
  for (auto* facets : {&part.apical_facets, &part.basal_facets}) {
    std::erase_if(*facets, [&](const Facet& facet) { return !cells[facet.cell.index()]; });
    for (Facet& facet : *facets) {
      facet.cell = place[facet.cell.index()];
      facet.element = element[facet.element.index()];
    }
  }
  for (auto& [name, set] : part.regions) set = inherited(division, set);
  for (auto& [name, values] : part.cell_arrays) values = inherited(division, values);
  tissue = std::move(part);
  return division;
}

std::vector<NodeId> drop_unused_nodes(Tissue& tissue) {
  std::vector<NodeId> now(tissue.node_count()), before;
  for (const auto& nodes : tissue.elements)
    for (const NodeId node : nodes) now[node.index()] = node;
  Vectors positions;
  std::vector<NodeMean> hanging;
  const std::size_t free_nodes = tissue.free_node_count();
  for (NodeId& node : now) {
    if (!node.valid()) continue;
    before.push_back(node);
    if (node.index() >= free_nodes) hanging.push_back(tissue.hanging[node.index() - free_nodes]);
    node = NodeId(positions.size());
    positions.push_back(tissue.rest_positions[before.back().index()]);
  }
  // Nodes that carry hanging nodes of a cell belong to the cell.
  for (NodeMean& mean : hanging)
    for (auto& [node, weight] : mean) node = now[node.index()];
  tissue.hanging = std::move(hanging);
  const auto renumber = [&](auto& nodes) {
    for (NodeId& node : nodes) node = now[node.index()];
  };
  for (auto& nodes : tissue.elements) renumber(nodes);
  for (Cell& cell : tissue.cells) {
    renumber(cell.corners);
    for (CellEdge& edge : cell.edges) renumber(edge.nodes);
    for (CellLine& line : cell.lines) renumber(line.chain.nodes);
    for (auto& wall : cell.walls)
      for (WallStop& stop : wall) stop = {stop.at, now[stop.basal.index()], now[stop.apical.index()]};
  }
  for (auto* facets : {&tissue.apical_facets, &tissue.basal_facets})
    for (Facet& facet : *facets) renumber(facet.nodes);
  tissue.rest_positions = std::move(positions);
  return before;
}

}  // namespace plica
