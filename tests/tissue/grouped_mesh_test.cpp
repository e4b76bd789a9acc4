// Cells of several hexahedra: what a tissue's mesh says comes back as the same tissue.
#include <gtest/gtest.h>

#include "support/mesh_error.hpp"
#include "support/prisms.hpp"
#include "support/same_tissue.hpp"
#include "tissue/files/child_reading.hpp"
#include "tissue/hexahedral_mesh.hpp"
#include "tissue/shapes/embryo.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {
namespace {

HexahedralMesh mesh_of(const Tissue& tissue) {
  HexahedralMesh mesh;
  mesh.points = tissue.rest_positions;
  mesh.cells = tissue.elements;
  mesh.groups = groups_of(tissue);
  return mesh;
}

Tissue polygons(PolygonSplit split, int layers = 1) {
  return tissue_from_prisms(support::irregular_polygons(8, 7, 4, 10, 0.15, 1), split, layers);
}

TEST(GroupedMesh, ComesBackTheSame) {
  int count = 0;
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites})
    for (const int layers : {1, 3}) {
      const Tissue sheet = polygons(split, layers),
                   egg = build_egg({250, 120, 120, {}, {}}, 150, 1, {20, split, layers});
      for (const Tissue* tissue : {&sheet, &egg}) {
        support::expect_same_tissue(tissue_from_mesh(mesh_from_bytes(mesh_to_bytes(mesh_of(*tissue))), {1, 1, 1}),
                                    *tissue);
        ++count;
      }
    }
  for (const std::array<int, 3>& elements : {std::array{2, 2, 1}, {1, 2, 3}}) {
    const Tissue pill = build_shell({460, 280, 40, {6, 3, 4}, elements}),
                 block = build_block({60, 40, 20, {3, 2, 1}, elements});
    for (const Tissue* tissue : {&pill, &block}) {
      support::expect_same_tissue(tissue_from_mesh(mesh_of(*tissue), {1, 1, 1}), *tissue);
      ++count;
    }
  }
  EXPECT_EQ(count, 12);
  EXPECT_TRUE(groups_of(build_block({60, 40, 20, {3, 2, 1}, {1, 1, 1}})).is_empty());
}

// As others may write it: cells in another order than their hexahedra, these in any, upside down.
TEST(GroupedMesh, OfMixedOrder) {
  const Tissue tissue = polygons(PolygonSplit::kites);
  const HexahedralMesh mesh = mesh_of(tissue);
  HexahedralMesh mixed = mesh;
  const std::size_t n = mesh.cells.size();
  mixed.arrays["gene"].resize(n);
  for (std::size_t e = 0; e < n; ++e) {
    const auto& [a, b, c, d, p, q, r, s] = mesh.cells[n - 1 - e];
    mixed.cells[e] = {q, p, s, r, b, a, d, c};
    mixed.groups.cell_of[e] = 10 + 2 * mesh.groups.cell_of[n - 1 - e];
    mixed.arrays["gene"][e] = mesh.groups.cell_of[n - 1 - e] + (e % 2 == 0 ? 0 : 0.5);
  }
  mixed.apical_faces.assign(n, 4);
  const Tissue back = tissue_from_mesh(mixed, {1, 1, 1});
  ASSERT_EQ(back.cells.size(), tissue.cells.size());
  for (std::size_t c = 0; c < back.cells.size(); ++c) {
    EXPECT_EQ(back.cells[c].corners, tissue.cells[c].corners);
    EXPECT_NEAR(cell_volume(back, back.cells[c], back.rest_positions),
                cell_volume(tissue, tissue.cells[c], tissue.rest_positions), 1e-9);
    EXPECT_NEAR(back.cell_arrays.at("gene")[c], static_cast<double>(c) + 0.25, 0.11);
  }
}

TEST(GroupedMesh, SaysWhatIsWrong) {
  const HexahedralMesh good = mesh_of(polygons(PolygonSplit::diagonals));
  const auto expect = [&](const auto& spoil, const std::string& said) {
    HexahedralMesh mesh = good;
    spoil(mesh);
    expect_mesh_error([&] { tissue_from_mesh(mesh, {1, 1, 1}); }, said);
  };
  expect([](auto& m) { m.groups.cell_of.pop_back(); }, "cell_id has ");
  expect([](auto& m) { m.points.emplace_back(0, 0, 0); }, "belongs to no hexahedron; remove it");
  expect([](auto& m) { m.groups.corner_counts.pop_back(); }, "cell_corner_counts has 55 values for 56 cells");
  expect([](auto& m) { m.groups.corner_counts[0] = 5; }, "um has 5 corners; give 6 or more");
  expect([](auto& m) { m.groups.corner_counts[55] += 2; }, "cell 55 at (");
  expect([](auto& m) { m.groups.corners.push_back(0); }, "cell_corner_counts adds up to");
  expect([](auto& m) { m.groups.corners[0] = -1; }, "um is node -1, which is not free");
  expect([](auto& m) { m.groups.corners[0] = static_cast<int>(m.points.size()) - 1; }, "which is not free");
  expect([](auto& m) { std::swap(m.groups.corners[0], m.groups.corners[1]); }, "the corners of cell 0 at (");
  expect([](auto& m) { m.groups.hanging.pop_back(); }, "hanging_nodes must give, for each");
  expect([](auto& m) { m.groups.hanging[1] = 1 << 20; }, "which is not free");
  expect([](auto& m) { m.groups.hanging[1] = m.groups.hanging[4]; }, "does not lie in the middle between them");
  expect([](auto& m) { m.groups.elements_per_cell = {2, 2}; }, "elements_per_cell has 2 numbers for 56 cells");
  expect([](auto& m) { m.groups.elements_per_cell.assign(3 * 56, 1); }, "hexahedra; elements_per_cell is 1 x 1 x 1");
  expect_mesh_error([&] { tissue_from_mesh(good, {2, 2, 1}); }, "cells of this file already have several");
  HexahedralMesh grid = mesh_of(build_block({60, 40, 20, {3, 2, 1}, {2, 2, 1}}));
  std::swap(grid.cells[0], grid.cells[1]);
  expect_mesh_error([&] { tissue_from_mesh(grid, {1, 1, 1}); }, "do not form a grid of 2 x 2 x 1");
}

}  // namespace
}  // namespace plica
