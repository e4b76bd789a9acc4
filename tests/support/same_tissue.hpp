// Two tissues that should be the same, to the bit.
#pragma once

#include "support/testing.hpp"
#include "tissue/tissue.hpp"

namespace plica::support {

inline void expect_same_edge(const CellEdge& one, const CellEdge& other) {
  EXPECT_EQ(one.nodes, other.nodes);
  EXPECT_EQ(one.direction, other.direction);
  EXPECT_EQ(one.side, other.side);
  EXPECT_EQ(one.along, other.along);
}

inline void expect_same_facets(const std::vector<Facet>& one, const std::vector<Facet>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t f = 0; f < one.size(); ++f) {
    EXPECT_EQ(one[f].nodes, other[f].nodes);
    EXPECT_EQ(one[f].cell, other[f].cell);
    EXPECT_EQ(one[f].element, other[f].element);
  }
}

/// Outlines and splits of the cells of a sheet, independent of the numbers of its vertices and walls.
inline auto outlines_of(const Sheet& sheet) {
  std::vector<std::pair<std::vector<std::tuple<std::vector<NodeId>, double, CellId>>, std::vector<OutlineQuad>>> cells;
  for (std::size_t c = 0; c < sheet.cells.size(); ++c) {
    auto& [ring, split] = cells.emplace_back();
    for (const Stop& stop : sheet.cells[c].ring)
      ring.emplace_back(sheet.vertices[stop.vertex.index()].nodes, stop.at,
                        sheet.walls[stop.wall.index()].beyond(CellId(c)));
    split = sheet.cells[c].quadrilaterals;
  }
  return cells;
}

/// But for places on a grid, arrays, regions and the shape, which a file of hexahedra does not have.
inline void expect_same_tissue(const Tissue& one, const Tissue& other) {
  EXPECT_EQ(one.rest_positions, other.rest_positions);
  EXPECT_EQ(one.hanging, other.hanging);
  EXPECT_EQ(one.elements, other.elements);
  EXPECT_EQ(one.element_cell, other.element_cell);
  EXPECT_EQ(one.element_rest_shape, other.element_rest_shape);
  EXPECT_EQ(one.next_cell_id, other.next_cell_id);
  expect_same_facets(one.apical_facets, other.apical_facets);
  expect_same_facets(one.basal_facets, other.basal_facets);
  EXPECT_EQ(outlines_of(one.sheet), outlines_of(other.sheet));
  ASSERT_EQ(one.cells.size(), other.cells.size());
  for (std::size_t c = 0; c < one.cells.size(); ++c) {
    const Cell &a = one.cells[c], &b = other.cells[c];
    EXPECT_EQ(a.first_element, b.first_element);
    EXPECT_EQ(a.element_count, b.element_count);
    EXPECT_EQ(a.is_of_grid, b.is_of_grid);
    EXPECT_EQ(a.corners, b.corners);
    EXPECT_EQ(a.rest_shape, b.rest_shape);
    EXPECT_EQ(a.lineage.id, b.lineage.id);
    ASSERT_EQ(a.edges.size(), b.edges.size());
    for (std::size_t e = 0; e < a.edges.size(); ++e) expect_same_edge(a.edges[e], b.edges[e]);
    ASSERT_EQ(a.lines.size(), b.lines.size());
    for (std::size_t l = 0; l < a.lines.size(); ++l) {
      expect_same_edge(a.lines[l].chain, b.lines[l].chain);
      EXPECT_EQ(a.lines[l].share, b.lines[l].share);
    }
  }
}

}  // namespace plica::support
