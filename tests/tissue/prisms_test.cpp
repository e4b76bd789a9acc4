// A tissue of polygonal cells is whole: cells fill what the polygons span, and neighbours have their walls in common.
#include "tissue/prisms.hpp"

#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "support/prisms.hpp"
#include "support/whole.hpp"
#include "tissue/mesh_quality.hpp"

namespace plica {
namespace {

using namespace support;

using Case = std::pair<PolygonSplit, int>;  // split, layers

class Prisms : public testing::TestWithParam<Case> {
 protected:
  static Tissue of(const PrismSheet& sheet) {
    const auto [split, layers] = GetParam();
    return tissue_from_prisms(sheet, split, layers);
  }
  static bool hangs() { return GetParam().first == PolygonSplit::diagonals; }
};

INSTANTIATE_TEST_SUITE_P(Splits, Prisms,
                         testing::Values(Case{PolygonSplit::diagonals, 1}, Case{PolygonSplit::diagonals, 2},
                                         Case{PolygonSplit::kites, 1}, Case{PolygonSplit::kites, 3}),
                         [](const auto& given) {
                           return std::string(given.param.first == PolygonSplit::kites ? "kites" : "diagonals") +
                                  std::to_string(given.param.second);
                         });

double flat_area(const PrismSheet& sheet, std::size_t cell) {
  const auto& polygon = sheet.cells[cell];
  double twice = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    twice += sheet.apical[polygon[i]].cross(sheet.apical[polygon[(i + 1) % polygon.size()]]).z();
  return twice / 2;
}

TEST_P(Prisms, FillTheirPolygons) {
  const PrismSheet sheet = irregular_polygons(9, 8, 4, 12, 0.1, 3);
  const Tissue tissue = of(sheet);
  ASSERT_EQ(tissue.cells.size(), sheet.cells.size());
  std::map<std::size_t, int> of_sides;
  const std::vector<double> areas = apical_areas(tissue, tissue.rest_positions);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Cell& cell = tissue.cells[c];
    ++of_sides[cell.sides()];
    const double area = flat_area(sheet, c);
    EXPECT_GT(area, 0);
    EXPECT_NEAR(areas[c], area, 1e-9 * area);
    EXPECT_NEAR(cell_volume(tissue, cell, tissue.rest_positions), 12 * area, 1e-9 * area);
    ASSERT_EQ(cell.sides(), sheet.cells[c].size());
    for (std::size_t i = 0; i < cell.sides(); ++i) {
      EXPECT_EQ(tissue.rest_positions[cell.apical_corners()[i].index()], sheet.apical[sheet.cells[c][i]]);
      EXPECT_EQ(tissue.rest_positions[cell.basal_corners()[i].index()], sheet.basal[sheet.cells[c][i]]);
      EXPECT_LT(cell.corners[i].index(), tissue.free_node_count()) << "corners are free";
    }
    EXPECT_EQ(cell.edges.size(), 3 * cell.sides());
  }
  for (const std::size_t sides : {5, 6, 7}) EXPECT_GT(of_sides[sides], 0) << sides;
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.1);
}

TEST_P(Prisms, HaveTheirWallsInCommon) {
  const Tissue tissue = of(bent(irregular_polygons(9, 8, 4, 12, 0.1, 3), [](const Vec3& x) {
    const double angle = x.x() / 60, radius = 60 + x.z();
    return Vec3(radius * std::sin(angle), x.y(), radius * std::cos(angle) + 3 * std::sin(x.y() / 20));
  }));
  expect_faces_enclose_the_cells(tissue);
  std::set<NodeId> used;
  for (const auto& element : tissue.elements) used.insert(element.begin(), element.end());
  EXPECT_EQ(used.size(), tissue.node_count());
  EXPECT_EQ(!tissue.hanging.empty(), hangs());
  for (std::size_t h = 0; h < tissue.hanging.size(); ++h) {
    double sum = 0;
    for (const auto& [node, weight] : tissue.hanging[h]) {
      EXPECT_LT(node.index(), tissue.free_node_count());
      sum += weight;
    }
    EXPECT_EQ(sum, 1);
    EXPECT_LE((mean_of(tissue.hanging[h], tissue.rest_positions) - tissue.rest_positions[tissue.free_node_count() + h])
                  .norm(),
              1e-12);
  }
}

TEST_P(Prisms, TakeTrianglesToo) {
  PrismSheet sheet;
  sheet.apical = {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {0, 10, 0}, {5, 5, 0}, {16, 5, 0}};
  for (const Vec3& x : sheet.apical) sheet.basal.push_back(x - 8 * Vec3::UnitZ());
  sheet.cells = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 5, 2}};
  const Tissue tissue = of(sheet);
  for (const Cell& cell : tissue.cells)
    EXPECT_NEAR(cell_volume(tissue, cell, tissue.rest_positions), 8 * (&cell == &tissue.cells[4] ? 30 : 25), 1e-9);
  EXPECT_GT(min_scaled_jacobian(tissue, tissue.rest_positions), 0.1);
  expect_faces_enclose_the_cells(tissue);
}

TEST_P(Prisms, EdgesAreChainsThatKnowTheirDirection) {
  const Tissue tissue = of(honeycomb(4, 4, 5, 10));
  const auto [split, layers] = GetParam();
  for (const Cell& cell : tissue.cells)
    for (const CellEdge& edge : cell.edges) {
      if (edge.side == CellSide::lateral) {
        EXPECT_EQ(edge.direction, EdgeDirection::lateral);
        EXPECT_EQ(edge.nodes.size(), static_cast<std::size_t>(layers) + 1);
        EXPECT_GT(tissue.rest_positions[edge.nodes.back().index()].z(),
                  tissue.rest_positions[edge.nodes.front().index()].z());
        continue;
      }
      EXPECT_EQ(edge.nodes.size(), split == PolygonSplit::kites ? 3u : 2u);
      // Hexagons stand on a corner: two edges run across, four at 30 degrees to x.
      if (edge.direction == EdgeDirection::across)
        EXPECT_NEAR(edge.along, 0, 1e-12);
      else
        EXPECT_NEAR(edge.along, 0.75, 1e-12);
    }
}

TEST(Prisms, OfFourCornersAreAsAGridMakesThem) {
  PrismSheet sheet;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 4; ++i)
      sheet.apical.emplace_back(10 * i, 8 * j, 0), sheet.basal.emplace_back(10 * i, 8 * j, -20);
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = 0; i < 3; ++i) sheet.cells.push_back({i + 4 * j, i + 1 + 4 * j, i + 5 + 4 * j, i + 4 + 4 * j});
  const Tissue prisms = tissue_from_prisms(sheet, PolygonSplit::diagonals, 1);
  const Tissue block = build_block({.length_um = 30, .width_um = 16, .cell_height_um = 20, .cells = {3, 2, 1}});
  ASSERT_EQ(prisms.elements.size(), block.elements.size());
  EXPECT_TRUE(prisms.hanging.empty());
  for (std::size_t e = 0; e < prisms.elements.size(); ++e)
    EXPECT_NEAR(hex_volume(prisms.element_rest_shape[e]), hex_volume(block.element_rest_shape[e]), 1e-9);
}

}  // namespace
}  // namespace plica
