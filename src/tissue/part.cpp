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
  for (auto* sets : {&part.regions, &part.cell_arrays})
    for (auto& [name, set] : *sets) set = inherited(division, set);
  tissue = std::move(part);
  return division;
}

}  // namespace plica
