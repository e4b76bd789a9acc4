// Each face once, outward, and what they enclose is the cells' volumes: also after divisions.
#include "tissue/faces.hpp"

#include <gtest/gtest.h>

#include "support/divided.hpp"
#include "support/whole.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {
namespace {

using namespace support;

TEST(Faces, OfABlockAreItsWalls) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}});
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_EQ(counted.lateral, 3u * 3 + 4 * 2);  // walls along, walls across
  EXPECT_EQ(counted.rims, 2u * (3 + 2));
}

TEST(Faces, OfCellsOfSeveralElementsAreTheirElements) {
  const Tissue tissue = build_block(
      {.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}, .elements_per_cell = {2, 1, 2}});
  const Counted counted = expect_faces_enclose_the_cells(tissue);
  EXPECT_EQ(counted.lateral, (3u * 3 * 2 + 4 * 2) * 2);
}

TEST(Faces, OfAnEmbryoHaveTwoCellsEach) {
  const Counted counted = expect_faces_enclose_the_cells(build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}}));
  EXPECT_EQ(counted.rims, 0u);
  EXPECT_EQ(counted.lateral, 2u * 128);  // four sides a cell, two cells a side
}

// One wall may face two daughters: it is two faces then.
TEST(Faces, FollowDivisions) {
  Tissue tissue = build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}});
  Random random(3);
  Counted before = expect_faces_enclose_the_cells(tissue);
  for (int round = 0; round < 3; ++round) {
    divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), 0);
    const Counted counted = expect_faces_enclose_the_cells(tissue);
    EXPECT_GT(counted.lateral, before.lateral);
    EXPECT_NEAR(counted.rim_area, before.rim_area, 1e-9 * before.rim_area);  // a wall inside has a cell on both sides
    before = counted;
  }
}

TEST(Faces, RimOfAClosedSurfaceIsEmptyWhereNodesHang) {
  Tissue shell = build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}});
  Random random(3);
  for (int round = 0; round < 3; ++round) {
    EXPECT_TRUE(rim_of(shell, shell.apical_facets).empty());
    divide(shell, cuts_of(random_divisions(shell, 0.5, random)), 0);
  }
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites}) {
    const Tissue egg = build_egg({250, 120, 120, 11, 5}, 300, 1, {20, split, 1});
    EXPECT_TRUE(rim_of(egg, egg.basal_facets).empty());
    EXPECT_FALSE(rim_of(egg, std::span(egg.basal_facets).subspan(1)).empty());
  }
}

// A block's, once about it and outward: what a division adds to it does not change what it goes round.
TEST(Faces, RimOfAnOpenSurfaceGoesRoundIt) {
  Tissue tissue = build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}});
  Random random(3);
  for (int round = 0; round < 3; ++round) {
    const auto rim = rim_of(tissue, tissue.apical_facets);
    EXPECT_GE(rim.size(), 2U * (4 + 3));
    double twice_area = 0;
    for (const auto& [from, to] : rim)
      twice_area += tissue.rest_positions[from.index()].cross(tissue.rest_positions[to.index()]).z();
    EXPECT_NEAR(twice_area, 2 * 80 * 60, 1e-9);
    divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), 0);
  }
}

}  // namespace
}  // namespace plica
