// A tissue after cuts: what exists, what is conserved, and that neighbours fit whatever is cut.
#include "tissue/division.hpp"

#include <gtest/gtest.h>

#include "support/divided.hpp"

namespace plica {
namespace {

using namespace support;

const BlockShape three_cells{.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}};
const BlockShape sheet{.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}};

Tissue cut(Tissue tissue, const std::vector<CellCut>& cuts) {
  divide(tissue, cuts, 0);
  return tissue;
}

TEST(Division, OfTheMiddleOfThreeCellsGivesFourFreeNodesAndASharedFacet) {
  Tissue tissue = build_block(three_cells);
  const Division division = divide(tissue, std::vector<CellCut>{{CellId(1), 0}}, 60);
  ASSERT_EQ(tissue.cells.size(), 4u);
  EXPECT_EQ(tissue.elements.size(), 4u);
  EXPECT_EQ(tissue.free_node_count(), 20u);
  EXPECT_TRUE(tissue.hanging.empty());
  const auto [low, high] = division.daughters.at(0);
  std::set<NodeId> shared;
  for (const NodeId node : tissue.cells[low.index()].corners)
    for (const NodeId other : tissue.cells[high.index()].corners)
      if (node == other) shared.insert(node);
  EXPECT_EQ(shared, (std::set<NodeId>{NodeId(16), NodeId(17), NodeId(18), NodeId(19)}));
  for (const NodeId node : shared) EXPECT_EQ(tissue.rest_positions[node.index()].x(), 0);
  for (const CellId daughter : {low, high}) {
    const Lineage& lineage = tissue.cells[daughter.index()].lineage;
    EXPECT_EQ(lineage.mother, 1);
    EXPECT_EQ(lineage.generation, 1);
    EXPECT_EQ(lineage.birth_s, 60);
    EXPECT_GE(lineage.id, 3);
  }
}

// Across the row, the neighbours' walls are cut too: the new stops are free, the neighbours' far sides hang.
TEST(Division, NeighboursOfACutGetElementsAndHangingNodesOfTheirOwn) {
  const Tissue tissue = cut(build_block(three_cells), {{CellId(1), 1}});
  EXPECT_EQ(tissue.free_node_count(), 20u);
  EXPECT_EQ(tissue.elements.size(), 6u);
  ASSERT_EQ(tissue.hanging.size(), 4u);  // basal and apical, at either end of the row
  for (const NodeMean& mean : tissue.hanging) {
    ASSERT_EQ(mean.size(), 2u);
    EXPECT_EQ(mean[0].second, 0.5);
    EXPECT_EQ(mean[1].second, 0.5);
  }
}

TEST(Division, LeavesTheVolumesOfOtherCellsAndTheirSumAsTheyWere) {
  int cases = 0;
  double worst_cell = 0, worst_sum = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    Tissue tissue = distorted_block(sheet, 2, seed);
    Random random(seed);
    for (int round = 0; round < 4; ++round) {
      Vectors positions = tissue.rest_positions;
      for (Vec3& x : positions) x += random.vector(0.3);
      tissue.place_hanging(positions);
      std::map<int, double> before;
      for (const Cell& cell : tissue.cells) before[cell.lineage.id] = cell_volume(tissue, cell, positions);
      const double sum_before = volume_of_cells(tissue, positions);
      const Division division = divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), round);
      positions = with_new_nodes(tissue, division, positions);
      for (const Cell& cell : tissue.cells)
        if (before.contains(cell.lineage.id))
          worst_cell =
              std::max(worst_cell, std::abs(cell_volume(tissue, cell, positions) / before[cell.lineage.id] - 1));
      for (const auto& [low, high] : division.daughters) {
        const Cell &a = tissue.cells[low.index()], &b = tissue.cells[high.index()];
        const double halves = cell_volume(tissue, a, positions) + cell_volume(tissue, b, positions);
        worst_cell = std::max(worst_cell, std::abs(halves / before.at(a.lineage.mother) - 1));
      }
      const double sum = volume_of_cells(tissue, positions);
      worst_sum = std::max(
          {worst_sum, std::abs(sum / sum_before - 1), std::abs(sum / volume_inside_boundary(tissue, positions) - 1)});
      ++cases;
    }
  }
  EXPECT_LE(worst_cell, 1e-13);
  EXPECT_LE(worst_sum, 1e-13);
  std::cout << "volumes over " << cases << " random rounds: cells off by " << worst_cell << ", sum by " << worst_sum
            << "\n";
}

// Positions of nodes that move at will: nothing opens, since neighbours share every stop of their common wall.
TEST(Division, OpensNoGapWhenFreeNodesMove) {
  Tissue tissue = build_block(sheet);
  Random random(5);
  for (int round = 0; round < 4; ++round) {
    divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), round);
    Vectors positions = tissue.rest_positions;
    for (Vec3& x : positions) x += random.vector(0.2);
    tissue.place_hanging(positions);
    EXPECT_NEAR(volume_of_cells(tissue, positions) / volume_inside_boundary(tissue, positions), 1, 1e-13);
  }
}

// Four new nodes a cut; fewer where a neighbour's cut has put its stop there already, two more for each line that a
// neighbour's cut has drawn across the mother.
TEST(Division, GivesAboutFourFreeNodesACut) {
  Tissue tissue = build_shell({.length_um = 280, .cells = {9, 9, 8}});
  Random random(2);
  for (int round = 0; round < 3; ++round) {
    const std::size_t before = tissue.free_node_count();
    const auto cuts = cuts_of(random_divisions(tissue, 0.5, random));
    std::size_t lines = 0;
    for (const CellCut& cut : cuts) {
      std::set<double> places;  // along u or v: walls 2 and 3 run against them
      for (const int wall : {1 - cut.first_wall, 3 - cut.first_wall})
        for (const WallStop& stop : tissue.cells[cut.cell.index()].walls[wall])
          places.insert(wall < 2 ? stop.at : 1 - stop.at);
      lines += places.size() - 2;
    }
    const Division division = divide(tissue, cuts, round);
    std::set<NodeId> ends;  // corners of the new facets
    for (const auto& [low, high] : division.daughters)
      for (const NodeId node : tissue.cells[low.index()].corners)
        for (const NodeId other : tissue.cells[high.index()].corners)
          if (node == other && node.index() >= before) ends.insert(node);
    EXPECT_EQ(tissue.free_node_count() - before, ends.size() + 2 * lines);
    EXPECT_GT(tissue.free_node_count() - before, 3 * cuts.size());
    std::cout << cuts.size() << " cuts, " << ends.size() << " + " << 2 * lines << " new free nodes\n";
  }
}

// Weights of hanging nodes are dyadic and add up to 1, so a rigid or affine motion of the free nodes moves them along.
TEST(Division, HangingNodesFollowAffineMotion) {
  Tissue tissue = build_block(sheet);
  Random random(9);
  for (int round = 0; round < 4; ++round) divide(tissue, cuts_of(random_divisions(tissue, 0.6, random)), round);
  ASSERT_FALSE(tissue.hanging.empty());
  const Mat3 turn = random.rotation() + 0.3 * Mat3::Random();
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = turn * x + Vec3(1, 2, 3);
  Vectors placed = positions;
  tissue.place_hanging(placed);
  double worst = 0;
  for (std::size_t n = 0; n < positions.size(); ++n) worst = std::max(worst, (placed[n] - positions[n]).norm());
  EXPECT_LE(worst, 1e-12);
  for (const NodeMean& mean : tissue.hanging) {
    double sum = 0;
    for (const auto& [node, weight] : mean) {
      EXPECT_LT(node.index(), tissue.free_node_count());
      sum += weight;
    }
    EXPECT_EQ(sum, 1);
  }
}

TEST(Division, OfNeighboursAtOnceDoesNotDependOnTheirOrder) {
  const auto places = [](const Tissue& tissue) {
    std::multiset<std::array<double, 3>> found;
    for (const Vec3& x : tissue.rest_positions) found.insert({x.x(), x.y(), x.z()});
    return found;
  };
  int patterns = 0;
  for (unsigned pattern = 0; pattern < 4096; pattern += 7) {
    std::vector<CellCut> cuts;
    for (int c = 0; c < 12; ++c) cuts.push_back({CellId(c), static_cast<int>(pattern >> c & 1)});
    const Tissue forward = cut(build_block(sheet), cuts);
    std::reverse(cuts.begin(), cuts.end());
    const Tissue backward = cut(build_block(sheet), cuts);
    ASSERT_EQ(places(forward), places(backward)) << "pattern " << pattern;
    ++patterns;
  }
  std::cout << patterns << " patterns of 12 neighbours dividing at once\n";
}

TEST(Division, RestShapesOfDaughtersAreTheHalvesOfTheirMothers) {
  Tissue tissue = distorted_block(three_cells, 3, 4);
  const HexPoints mother = hexahedron(tissue.cells[1].rest_shape);
  const Division division = divide(tissue, std::vector<CellCut>{{CellId(1), 0}}, 0);
  const HexPoints low = hexahedron(tissue.cells[division.daughters[0][0].index()].rest_shape);
  const HexPoints high = hexahedron(tissue.cells[division.daughters[0][1].index()].rest_shape);
  for (const int i : {0, 3, 4, 7}) EXPECT_LE((low[i] - mother[i]).norm(), 1e-13);
  for (const int i : {1, 2, 5, 6}) EXPECT_LE((high[i] - mother[i]).norm(), 1e-13);
  for (const auto& [a, b] : {std::pair{1, 0}, {2, 3}, {5, 4}, {6, 7}}) {
    EXPECT_LE((low[a] - 0.5 * (mother[a] + mother[b])).norm(), 1e-13);
    EXPECT_LE((high[b] - low[a]).norm(), 1e-13);
  }
  EXPECT_NEAR(hex_volume(low) + hex_volume(high), hex_volume(mother), 1e-9);
}

TEST(Division, KeepsRegionsArraysAndPlaces) {
  Tissue tissue = build_block(three_cells);
  tissue.regions["middle"] = {false, true, false};
  const Division division = divide(tissue, std::vector<CellCut>{{CellId(1), 0}}, 0);
  EXPECT_EQ(tissue.regions["middle"], (CellSet{false, true, false, true}));
  EXPECT_EQ(tissue.regions["all"], CellSet(4, true));
  EXPECT_EQ(inherited(division, std::vector<int>{10, 11, 12}), (std::vector<int>{10, 11, 12, 11}));
}

TEST(Division, IsRefusedWhereCellsHaveSeveralElementsOrLayers) {
  EXPECT_FALSE(why_indivisible(build_block(three_cells)));
  BlockShape refined = three_cells, layered = three_cells;
  refined.elements_per_cell = {2, 1, 1};
  layered.cells = {3, 1, 2};
  EXPECT_TRUE(why_indivisible(build_block(refined)));
  EXPECT_TRUE(why_indivisible(build_block(layered)));
}

}  // namespace
}  // namespace plica
