// Division of hexahedra and of polygons.
#include "tissue/division.hpp"

#include "simulation/division_rules.hpp"
#include "support/divided.hpp"
#include "support/prisms.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace {

const BlockShape three_cells{.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}};
const BlockShape flat_sheet{.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}};

Tissue cut(Tissue tissue, const std::vector<CellCut>& cuts) {
  divide(tissue, cuts, 0);
  return tissue;
}

TEST(Division, OfTheMiddleOfThreeCellsGivesFourFreeNodesAndASharedFacet) {
  Tissue tissue = build_block(three_cells);
  const TissueChange division = divide(tissue, std::vector<CellCut>{{CellId(1), 0}}, 60);
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
    Tissue tissue = distorted_block(flat_sheet, 2, seed);
    Random random(seed);
    for (int round = 0; round < 4; ++round) {
      Vectors positions = tissue.rest_positions;
      for (Vec3& x : positions) x += random.vector(0.3);
      tissue.place_hanging(positions);
      std::map<int, double> before;
      for (const Cell& cell : tissue.cells) before[cell.lineage.id] = cell_volume(tissue, cell, positions);
      const double sum_before = volume_of_cells(tissue, positions);
      const TissueChange division = divide(tissue, cuts_of(random_divisions(tissue, 0.5, random)), round);
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
  Tissue tissue = build_block(flat_sheet);
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
      const std::vector<Side> sides = tissue.sheet.cells[cut.cell.index()].sides();
      for (const int wall : {1 - cut.first_wall, 3 - cut.first_wall})
        for (const Stop& stop : sides[static_cast<std::size_t>(wall)])
          if (stop.at > 0) places.insert(wall < 2 ? stop.at : 1 - stop.at);
      lines += places.size();
    }
    const TissueChange division = divide(tissue, cuts, round);
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
  Tissue tissue = build_block(flat_sheet);
  Random random(9);
  for (int round = 0; round < 4; ++round) divide(tissue, cuts_of(random_divisions(tissue, 0.6, random)), round);
  ASSERT_FALSE(tissue.hanging.empty());
  const Mat3 turn = random.rotation() + 0.3 * Mat3::Random();
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = turn * x + Vec3(1, 2, 3);
  Vectors placed = positions;
  tissue.place_hanging(placed);
  EXPECT_LE(largest_distance(placed, positions), 1e-12);
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
    const Tissue forward = cut(build_block(flat_sheet), cuts);
    std::reverse(cuts.begin(), cuts.end());
    const Tissue backward = cut(build_block(flat_sheet), cuts);
    ASSERT_EQ(places(forward), places(backward)) << "pattern " << pattern;
    ++patterns;
  }
  std::cout << patterns << " patterns of 12 neighbours dividing at once\n";
}

TEST(Division, RestShapesOfDaughtersAreTheHalvesOfTheirMothers) {
  Tissue tissue = distorted_block(three_cells, 3, 4);
  const HexPoints mother = hexahedron(tissue.cells[1].rest_shape);
  const TissueChange division = divide(tissue, std::vector<CellCut>{{CellId(1), 0}}, 0);
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
  const TissueChange division = divide(tissue, std::vector<CellCut>{{CellId(1), 0}}, 0);
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

Tissue bent_sheet(unsigned seed, PolygonSplit split = PolygonSplit::diagonals, int layers = 1) {
  return tissue_from_prisms(bent(irregular_polygons(12, 12, 8, 20, 0.1, seed),
                                 [](const Vec3& x) {
                                   const double radius = 90 + x.z(), angle = x.x() / 90;
                                   return Vec3(radius * std::sin(angle), x.y(), radius * std::cos(angle));
                                 }),
                            split, layers);
}

Tissue egg(PolygonSplit split = PolygonSplit::diagonals, int layers = 1) {
  return build_egg({460, 180, 180, {}, {}}, 300, 1, {.height_um = 25, .split = split, .layers = layers});
}

// Across the longest axis, along the embryo or across it, of cells at random.
std::vector<CellCut> random_cuts(const Tissue& tissue, const Vectors& positions, std::size_t count, Random& random) {
  std::vector<CellCut> cuts;
  CutEnds taken;
  std::set<std::size_t> chosen;
  constexpr std::array planes = {DivisionPlane::longest_axis, DivisionPlane::transverse, DivisionPlane::sagittal};
  while (cuts.size() < count) {
    const auto c = static_cast<std::size_t>(0.5 * (random.number() + 1) * static_cast<double>(tissue.cells.size() - 1));
    if (!chosen.insert(c).second) continue;
    cuts.push_back(cut_by(planes[cuts.size() % 3], tissue, CellId(c), positions, taken));
  }
  return cuts;
}

double worst_element(const Tissue& tissue, const Vectors& positions) {
  double least = 1;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    least = std::min({least, hex_scaled_jacobian(gather(positions, tissue.elements[e])),
                      hex_scaled_jacobian(tissue.element_rest_shape[e])});
  return least;
}

struct Errors {
  double others = 0, halves = 0, gap = 0, least_jacobian = 1;
  int divisions = 0;
};

// 210 divisions in three rounds, every node moved by up to `size_um` before each. So there are daughters of the third
// generation.
Errors divide_three_times(Tissue tissue, double size_um, unsigned seed) {
  Random random(seed);
  Errors errors;
  int generation = 0;
  for (int round = 0; round < 3; ++round) {
    Vectors positions = tissue.rest_positions;
    for (Vec3& x : positions) x += random.vector(size_um);
    tissue.place_hanging(positions);
    std::map<int, double> before;
    for (const Cell& cell : tissue.cells) before[cell.lineage.id] = cell_volume(tissue, cell, positions);
    const std::vector<CellCut> cuts = random_cuts(tissue, positions, 70, random);
    const TissueChange division = divide(tissue, cuts, round, positions);
    positions = with_new_nodes(tissue, division, positions);
    errors.divisions += static_cast<int>(cuts.size());
    EXPECT_EQ(most_cells_at_a_vertex(tissue.sheet), 3u);
    errors.least_jacobian = std::min(errors.least_jacobian, worst_element(tissue, positions));
    for (const Cell& cell : tissue.cells)
      if (before.contains(cell.lineage.id))
        errors.others =
            std::max(errors.others, std::abs(cell_volume(tissue, cell, positions) / before[cell.lineage.id] - 1));
    for (const auto& [low, high] : division.daughters) {
      const Cell &a = tissue.cells[low.index()], &b = tissue.cells[high.index()];
      const double halves = cell_volume(tissue, a, positions) + cell_volume(tissue, b, positions);
      errors.halves = std::max(errors.halves, std::abs(halves / before.at(a.lineage.mother) - 1));
      generation = std::max(generation, a.lineage.generation);
    }
    Vectors elsewhere = tissue.rest_positions;
    for (Vec3& x : elsewhere) x += random.vector(0.2);
    tissue.place_hanging(elsewhere);
    errors.gap = std::max(errors.gap,
                          std::abs(volume_of_cells(tissue, elsewhere) / volume_inside_boundary(tissue, elsewhere) - 1));
  }
  EXPECT_EQ(generation, 3);
  return errors;
}

void check(const char* what, const Errors& errors) {
  EXPECT_EQ(errors.divisions, 210) << what;
  EXPECT_LE(errors.others, 1e-13) << what;
  EXPECT_LE(errors.gap, 1e-13) << what;
  EXPECT_GT(errors.least_jacobian, 0) << what;
  std::cout << what << ": " << errors.divisions << " divisions; volumes of other cells off by " << errors.others
            << ", sums of halves by " << errors.halves << ", inside of the boundary by " << errors.gap
            << "; worst scaled Jacobian " << errors.least_jacobian << "\n";
}

TEST(PolygonDivision, FitsThroughThreeGenerationsOfASheet) {
  for (const unsigned seed : {1u, 2u, 3u}) check("sheet", divide_three_times(bent_sheet(seed), 0.1, seed));
}

TEST(PolygonDivision, FitsThroughThreeGenerationsOfAnEgg) {
  for (const unsigned seed : {1u, 2u, 3u}) check("egg", divide_three_times(egg(), 0.1, seed));
}

TEST(PolygonDivision, OfAHexagonGivesTwoPentagonsAndStopsInItsNeighbours) {
  Tissue tissue = tissue_from_prisms(honeycomb(3, 3, 8, 20), PolygonSplit::diagonals, 1);
  const std::size_t middle = 4, nodes = tissue.free_node_count();
  ASSERT_EQ(tissue.cells[middle].sides(), 6u);
  const TissueChange division = divide(tissue, std::vector<CellCut>{{CellId(middle), 0, 3}}, 0);
  EXPECT_EQ(tissue.cells.size(), 10u);
  EXPECT_EQ(tissue.free_node_count(), nodes + 4);
  for (const CellId daughter : division.daughters[0]) EXPECT_EQ(tissue.cells[daughter.index()].sides(), 5u);
  int stops = 0;
  for (std::size_t c = 0; c < 9; ++c)
    if (c != middle) {
      EXPECT_EQ(tissue.cells[c].sides(), 6u);
      stops += static_cast<int>(tissue.sheet.cells[c].ring.size()) - 6;
    }
  EXPECT_EQ(stops, 2);
  const std::vector<double> areas = face_areas(tissue, CellSide::apical, tissue.rest_positions);
  EXPECT_NEAR(areas[middle], areas[9], 1e-9);
}

TEST(PolygonDivision, RestShapesOfDaughtersAreTheHalvesOfTheirMother) {
  Tissue tissue = bent_sheet(4);
  for (const std::size_t cell : {9u, 10u, 11u, 12u}) {
    const auto sides = static_cast<int>(tissue.cells[cell].sides());
    const CellCut cut{CellId(cell), 1, 1 + sides / 2};
    const auto [low, high] = halves_of_prism(cut, tissue.cells[cell].rest_shape);
    EXPECT_EQ(low.size() + high.size(), tissue.cells[cell].rest_shape.size() + 8);
    const TissueChange division = divide(tissue, std::vector<CellCut>{cut}, 0);
    const auto [a, b] = division.daughters[0];
    EXPECT_EQ(tissue.cells[a.index()].rest_shape, low);
    EXPECT_EQ(tissue.cells[b.index()].rest_shape, high);
    // Corners at rest lie where the rest shape says: rest positions of this tissue are the mother's shape.
    for (const CellId id : {a, b})
      for (std::size_t i = 0; i < tissue.cells[id.index()].corners.size(); ++i)
        EXPECT_LE((tissue.rest_positions[tissue.cells[id.index()].corners[i].index()] -
                   tissue.cells[id.index()].rest_shape[i])
                      .norm(),
                  1e-9);
  }
}

TEST(PolygonDivision, CutsAcrossTheLongestAxisIntoHalves) {
  PrismSheet sheet = honeycomb(3, 3, 8, 20);
  for (Vectors* vertices : {&sheet.apical, &sheet.basal})
    for (Vec3& x : *vertices) x.x() *= 2;
  const Tissue tissue = tissue_from_prisms(sheet, PolygonSplit::diagonals, 1);
  for (const auto& [plane, axis] :
       {std::pair(DivisionPlane::longest_axis, 0), {DivisionPlane::transverse, 0}, {DivisionPlane::sagittal, 1}}) {
    CutEnds taken;
    const CellCut cut = cut_by(plane, tissue, CellId(4), tissue.rest_positions, taken);
    EXPECT_EQ(cut.second_wall - cut.first_wall, 3);
    const auto middle_of = [&](int wall) {
      const auto corners = tissue.cells[4].apical_corners();
      return Vec3(0.5 * (tissue.rest_positions[corners[wall].index()] +
                         tissue.rest_positions[corners[(wall + 1) % 6].index()]));
    };
    const Vec3 way = (middle_of(cut.second_wall) - middle_of(cut.first_wall)).normalized();
    EXPECT_LE(std::abs(way[axis]), std::sqrt(4.0 / 7) + 1e-9) << axis;  // the best of three ways
  }
}

// Every cell at once: cuts of neighbours end beside each other, so a cell within has six neighbours on average.
TEST(PolygonDivision, OfAllCellsLeavesThreeAtEachVertex) {
  Tissue tissue = tissue_from_prisms(irregular_polygons(10, 10, 8, 20, 0.1, 1), PolygonSplit::diagonals, 1);
  for (int round = 0; round < 2; ++round) {
    std::vector<CellCut> cuts;
    CutEnds taken;
    for (std::size_t c = 0; c < tissue.cells.size(); ++c)
      cuts.push_back(cut_by(DivisionPlane::longest_axis, tissue, CellId(c), tissue.rest_positions, taken));
    divide(tissue, cuts, round);
    EXPECT_EQ(most_cells_at_a_vertex(tissue.sheet), 3u);
  }
  EXPECT_EQ(tissue.cells.size(), 400u);
  const auto neighbours = wall_neighbours(tissue);
  double sum = 0;
  int within = 0;
  for (std::size_t c = 0; c < 400; ++c) {
    const auto is_at_rim = [&](CellId cell) {
      return std::ranges::any_of(tissue.sheet.cells[cell.index()].ring, [&](const Stop& stop) {
        return !tissue.sheet.walls[stop.wall.index()].beyond(cell).valid();
      });
    };
    if (is_at_rim(CellId(c)) || std::ranges::any_of(neighbours[c], is_at_rim)) continue;
    sum += static_cast<double>(neighbours[c].size());
    ++within;
  }
  EXPECT_GT(within, 200);
  EXPECT_NEAR(sum / within, 6, 0.1);
  EXPECT_GT(worst_element(tissue, tissue.rest_positions), 0.05);
}

// A neighbour was cut before: rest shapes are parts of the mother's also where a cut ends beside its stop.
TEST(PolygonDivision, BesideTheStopOfANeighbourKeepsPlaces) {
  for (const PolygonSplit split : {PolygonSplit::diagonals, PolygonSplit::kites}) {
    Tissue tissue = tissue_from_prisms(honeycomb(3, 3, 8, 20), split, 1);
    const CellId beside = tissue.sheet.walls[tissue.sheet.cells[4].sides()[0].front().wall.index()].beyond(CellId(4));
    divide(tissue, std::vector<CellCut>{{CellId(4), 0, 3}}, 0);
    const std::vector<Side> sides = tissue.sheet.cells[beside.index()].sides();
    int shared = 0;  // with both daughters
    while (tissue.sheet.walls[sides[static_cast<std::size_t>(shared)].back().wall.index()].beyond(beside) !=
               CellId(4) &&
           tissue.sheet.walls[sides[static_cast<std::size_t>(shared)].front().wall.index()].beyond(beside) != CellId(4))
      ++shared;
    const CellCut cut =
        shared < 3 ? CellCut{beside, shared, shared + 3, 0.25, 0.5} : CellCut{beside, shared - 3, shared, 0.5, 0.25};
    const double sum = volume_of_cells(tissue, tissue.rest_positions);
    const TissueChange change = divide(tissue, std::vector<CellCut>{cut}, 0);
    EXPECT_EQ(most_cells_at_a_vertex(tissue.sheet), 3u);
    EXPECT_NEAR(volume_of_cells(tissue, tissue.rest_positions), sum, 1e-9);
    for (const CellId id : change.daughters[0]) {
      const Cell& cell = tissue.cells[id.index()];
      for (std::size_t i = 0; i < cell.corners.size(); ++i)
        EXPECT_LE((tissue.rest_positions[cell.corners[i].index()] - cell.rest_shape[i]).norm(), 1e-9);
      EXPECT_NEAR(rest_volume(tissue, cell), cell_volume(tissue, cell, tissue.rest_positions), 1e-8);
    }
  }
}

TEST(PolygonDivision, FitsThroughThreeGenerationsOfKitesAndLayers) {
  for (const auto& [split, layers] :
       {std::pair(PolygonSplit::kites, 1), {PolygonSplit::diagonals, 2}, {PolygonSplit::kites, 3}}) {
    check("sheet", divide_three_times(bent_sheet(1, split, layers), 0.1, 1));
    check("egg", divide_three_times(egg(split, layers), 0.1, 2));
  }
}

// It is cut along its lines, through its middle: elements stay as they are.
TEST(PolygonDivision, OfAHexagonOfKitesKeepsItsElements) {
  Tissue tissue = tissue_from_prisms(honeycomb(3, 3, 8, 20), PolygonSplit::kites, 2);
  const Tissue before = tissue;
  const TissueChange change = divide(tissue, std::vector<CellCut>{{CellId(4), 0, 3}}, 0);
  EXPECT_TRUE(change.new_nodes.empty());
  EXPECT_EQ(tissue.rest_positions, before.rest_positions);
  const auto elements_of = [](const Tissue& one) {
    std::multiset<std::set<NodeId>> elements;
    for (const auto& nodes : one.elements) elements.emplace(nodes.begin(), nodes.end());
    return elements;
  };
  EXPECT_EQ(elements_of(tissue), elements_of(before));
  for (const CellId daughter : change.daughters[0]) EXPECT_EQ(tissue.cells[daughter.index()].sides(), 6u);
  EXPECT_EQ(change.wall_origin.size(), before.sheet.walls.size() + 2);
  EXPECT_EQ(std::ranges::count(change.wall_origin, WallId()), 2);
  const double whole = cell_volume(before, before.cells[4], before.rest_positions);
  for (const CellId daughter : change.daughters[0])
    EXPECT_NEAR(cell_volume(tissue, tissue.cells[daughter.index()], tissue.rest_positions), whole / 2, 1e-9);
}

TEST(PolygonDivision, AddsVerticesOfAllLevels) {
  Tissue tissue = tissue_from_prisms(honeycomb(3, 3, 8, 20), PolygonSplit::diagonals, 3);
  const std::size_t nodes = tissue.free_node_count();
  divide(tissue, std::vector<CellCut>{{CellId(4), 0, 3}}, 0);
  EXPECT_EQ(tissue.free_node_count(), nodes + 2 * 4);
  EXPECT_NEAR(volume_of_cells(tissue, tissue.rest_positions), volume_inside_boundary(tissue, tissue.rest_positions),
              1e-9);
}

}  // namespace
