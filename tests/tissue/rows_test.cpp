#include "tissue/rows.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/prisms.hpp"
#include "tissue/faces.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {
namespace {

using namespace support;

// Seven columns, and an odd or an even number of rows across: a cell lies on the midline, or none does.
TEST(Rows, OfABlockAreItsRows) {
  int checked = 0;
  for (const int across : {5, 6}) {
    const Tissue block = build_block({.length_um = 140, .width_um = 60, .cell_height_um = 40, .cells = {7, across, 1}});
    const std::vector<int> found = half_cells_from_midline(block);
    for (int c = 0; c < 7 * across; ++c, ++checked) EXPECT_EQ(found[c], std::abs(2 * (c / 7) - (across - 1))) << c;
  }
  EXPECT_EQ(checked, 77);
}

// The belly's rows are those of its grid; its midline is not that of the back.
TEST(Rows, OfAPillAreThoseOfItsBelly) {
  const Tissue pill = build_shell({.length_um = 460, .cells = {18, 9, 8}});
  const std::vector<int> found = half_cells_from_midline(pill);
  int belly = 0;
  for (std::size_t c = 0; c < pill.cells.size(); ++c) {
    const GridPlace& place = *pill.cells[c].grid_place;
    // Half-way between the poles; nearer to them the shortest way leads over the end.
    if (place.face == GridPlace::Face::dorsal && place.place[0] == 9) {
      EXPECT_GE(found[c], 2 * 12);
    }
    if (place.face != GridPlace::Face::ventral) continue;
    EXPECT_EQ(found[c], std::abs(2 * place.place[1] - 8));
    ++belly;
  }
  EXPECT_EQ(belly, 162);
}

// Of polygons: every cell but those on the midline has a neighbour that is one cell nearer to it, and none that is
// nearer than that; on an egg a row is about a cell wide.
TEST(Rows, OfPolygonsAreCellsThatOnePasses) {
  const Tissue egg = build_egg({500, 180, 180, std::nullopt, std::nullopt}, 1500, 1, {});
  const std::vector<int> found = half_cells_from_midline(egg);
  const auto neighbours = wall_neighbours(egg);
  double width = 0, area = 0;
  int counted = 0;
  const std::vector<double> areas = apical_areas(egg, egg.rest_positions);
  for (std::size_t c = 0; c < egg.cells.size(); ++c) {
    ASSERT_GE(found[c], 0);
    int nearest = found[c];
    for (const CellId other : neighbours[c]) nearest = std::min(nearest, found[other.index()]);
    if (found[c] > 0) {
      EXPECT_EQ(nearest, found[c] - 2);
    }
    Vec3 middle = Vec3::Zero();
    for (const NodeId node : egg.cells[c].apical_corners()) middle += egg.rest_positions[node.index()];
    middle /= static_cast<double>(egg.cells[c].sides());
    if (std::abs(middle.x()) > 50 || found[c] != 10) continue;
    width += std::abs(std::hypot(middle.y(), middle.z()) * std::atan2(middle.y(), -middle.z())) / 5;
    area += areas[c];
    ++counted;
  }
  ASSERT_GT(counted, 5);
  EXPECT_NEAR(width / counted, std::sqrt(area / counted), 0.1 * std::sqrt(area / counted));
}

TEST(Rows, RingsLieAroundASet) {
  const Tissue block = build_block({.length_um = 140, .width_um = 100, .cell_height_um = 40, .cells = {7, 5, 1}});
  CellSet one(35, false);
  one[17] = true;  // column 3, row 2
  for (const int rings : {1, 2}) {
    const CellSet around = cells_around(block, one, rings);
    for (int c = 0; c < 35; ++c) {
      const int walls = std::abs(c % 7 - 3) + std::abs(c / 7 - 2);
      EXPECT_EQ(around[c], walls > 0 && walls <= rings) << c;
    }
  }
  EXPECT_EQ(std::ranges::count(cells_around(block, CellSet(35, true), 3), true), 0);
}

TEST(Rows, NeighboursOfAHexagonAreSix) {
  const Tissue sheet = tissue_from_prisms(honeycomb(5, 5, 4, 12), PolygonSplit::diagonals, 1);
  const auto neighbours = wall_neighbours(sheet);
  EXPECT_EQ(neighbours[12].size(), 6u);
  EXPECT_EQ(std::ranges::count(cells_around(
                                   sheet,
                                   [] {
                                     CellSet one(25, false);
                                     one[12] = true;
                                     return one;
                                   }(),
                                   1),
                               true),
            6);
}

}  // namespace
}  // namespace plica
