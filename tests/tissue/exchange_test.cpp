// Exchange of neighbours: walls that turn.
#include "tissue/exchange.hpp"

#include "support/divided.hpp"
#include "support/prisms.hpp"
#include "support/turns.hpp"
#include "tissue/extrusion.hpp"
#include "tissue/shapes/polygon_embryo.hpp"
#include "tissue/shapes/polygon_sheet.hpp"

namespace {

// Of elements of cells that have changed.
double worst_quality(const Tissue& tissue, const TissueChange& change, const Vectors& positions) {
  double least = 1;
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    if (change.is_remeshed(tissue.element_cell[e]))
      least = std::min({least, hex_scaled_jacobian(gather(positions, tissue.elements[e])),
                        hex_scaled_jacobian(tissue.element_rest_shape[e])});
  return least;
}

struct RandomTurns {
  int turns = 0, dropped = 0, at_rim = 0;
  double gap = 0, least_jacobian = 1;
};

// `inside`: volume that cells fill, wherever the nodes are that `shake` moves.
RandomTurns turn_at_random(Tissue tissue, int rounds, unsigned seed,
                           const std::function<double(const Tissue&, const Vectors&)>& inside, const Vec3& shake) {
  Random random(seed);
  RandomTurns sum;
  Vectors positions = tissue.rest_positions;
  const std::size_t nodes = tissue.free_node_count(), walls = tissue.sheet.walls.size(), cells = tissue.cells.size();
  for (int round = 0; round < rounds; ++round) {
    std::vector<WallTurn> turns = random_turns(tissue, cells / 12, random);
    double length = 0;
    for (const WallTurn& turn : turns)
      length += 0.6 * wall_length(tissue, turn, positions) / static_cast<double>(turns.size());
    const std::size_t tried = turns.size();
    const auto before = pairs_of(tissue);
    const TissueChange change = turned(tissue, turns, length, positions);
    sum.dropped += static_cast<int>(tried - turns.size());
    sum.turns += static_cast<int>(turns.size());
    EXPECT_EQ(tissue.free_node_count(), nodes);
    EXPECT_EQ(tissue.sheet.walls.size(), walls);
    EXPECT_EQ(std::ranges::count(change.wall_origin, WallId()), static_cast<std::ptrdiff_t>(turns.size()));
    expect_symmetric(tissue);
    const auto after = pairs_of(tissue);
    for (const WallTurn& turn : turns) {
      EXPECT_NEAR(wall_length(tissue, turn, positions), length, 1e-9);
      const bool is_at_rim = std::ranges::any_of(turn.cells(), [](CellId cell) { return !cell.valid(); });
      sum.at_rim += static_cast<int>(is_at_rim);
      EXPECT_FALSE(turn.right.valid() && after.contains(std::minmax(turn.left, turn.right)));
      if (turn.behind.valid() && turn.ahead.valid()) {
        EXPECT_FALSE(before.contains(std::minmax(turn.behind, turn.ahead)));
        EXPECT_TRUE(after.contains(std::minmax(turn.behind, turn.ahead)));
      }
    }
    sum.least_jacobian = std::min(sum.least_jacobian, worst_quality(tissue, change, positions));
    Vectors elsewhere = positions;
    for (Vec3& x : elsewhere) x += random.vector(0.2).cwiseProduct(shake);
    tissue.place_hanging_positions(elsewhere);
    sum.gap = std::max(sum.gap, std::abs(volume_of_cells(tissue, elsewhere) / inside(tissue, elsewhere) - 1));
    smooth(tissue, positions);
  }
  return sum;
}

void check(const char* what, const RandomTurns& sum, int least) {
  EXPECT_GE(sum.turns, least) << what;
  EXPECT_LE(sum.gap, 1e-12) << what;
  EXPECT_GT(sum.least_jacobian, 0) << what;
  std::cout << what << ": " << sum.turns << " turns, " << sum.at_rim << " of them at the rim; " << sum.dropped
            << " dropped for their elements; inside of the boundary off by " << sum.gap << "; worst scaled Jacobian "
            << sum.least_jacobian << "\n";
}

const PolygonCells cells_of_diagonals{.height_um = 10};

TEST(Exchange, LeavesNoGapInASheet) {
  for (const int layers : {1, 2}) {
    const Tissue sheet = tissue_from_prisms(irregular_polygons(12, 12, 4, 10, 0.1, 3), PolygonSplit::diagonals, layers);
    const RandomTurns sum = turn_at_random(sheet, 20, 1, volume_inside_boundary, Vec3::Ones());
    check("sheet", sum, 100);
    EXPECT_GT(sum.at_rim, 5);
  }
}

TEST(Exchange, LeavesNoGapInAnEgg) {
  check("egg",
        turn_at_random(build_egg({460, 180, 180, {}, {}}, 300, 1, {.height_um = 25}), 10, 2, volume_inside_boundary,
                       Vec3::Ones()),
        100);
}

// Nodes that move in the plane leave the volume of a periodic sheet.
TEST(Exchange, LeavesNoGapInAPeriodicSheet) {
  const SheetShape shape{.length_um = 90, .width_um = 70, .is_periodic = {true, true}};
  const auto whole = [](const Tissue&, const Vectors&) { return 90.0 * 70 * 10; };
  check("periodic sheet", turn_at_random(build_sheet(shape, 200, 1, cells_of_diagonals), 20, 3, whole, Vec3(1, 1, 0)),
        150);
}

// Bent about an axis along which it is periodic.
TEST(Exchange, FitsABentSheetWithARimAndAPeriod) {
  SheetShape shape{.length_um = 90, .width_um = 90, .curvature_per_um = {0, 0.01}, .is_periodic = {true, false}};
  const auto own = [](const Tissue& tissue, const Vectors& positions) { return volume_of_cells(tissue, positions); };
  check("bent sheet", turn_at_random(build_sheet(shape, 150, 1, cells_of_diagonals), 10, 4, own, Vec3::Ones()), 60);
}

TEST(Exchange, OfAHoneycombsWallMakesPentagonsAndHeptagons) {
  Tissue tissue = tissue_from_prisms(honeycomb(5, 5, 8, 20), PolygonSplit::diagonals, 1);
  tissue.regions["one"] = CellSet(25, false);
  tissue.regions["one"][12] = true;
  const Tissue before = tissue;
  std::vector<WallTurn> turns = possible_turns(tissue.sheet);
  std::erase_if(turns, [](const WallTurn& turn) { return turn.left != CellId(12) && turn.right != CellId(12); });
  ASSERT_EQ(turns.size(), 6u);
  turns.resize(1);
  Vectors positions = tissue.rest_positions;
  const TissueChange change = turned(tissue, turns, 3, positions);
  ASSERT_EQ(turns.size(), 1u);
  for (const CellId cell : {turns[0].left, turns[0].right}) EXPECT_EQ(tissue.cells[cell.index()].sides(), 5u);
  for (const CellId cell : {turns[0].behind, turns[0].ahead}) EXPECT_EQ(tissue.cells[cell.index()].sides(), 7u);
  EXPECT_EQ(std::ranges::count(change.remeshed, true), 4);
  EXPECT_EQ(tissue.regions, before.regions);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    EXPECT_NEAR(rest_volume(tissue, tissue.cells[c]) / rest_volume(before, before.cells[c]), 1, 1e-12);
    if (change.remeshed[c]) continue;
    EXPECT_EQ(tissue.cells[c].rest_shape, before.cells[c].rest_shape);
  }
  // Turned again, neighbours are as before.
  std::vector<WallTurn> back = possible_turns(tissue.sheet);
  std::erase_if(back, [&](const WallTurn& turn) { return turn.wall != turns[0].wall; });
  ASSERT_EQ(back.size(), 1u);
  turned(tissue, back, 8, positions);
  EXPECT_EQ(pairs_of(tissue), pairs_of(before));
  for (const std::size_t level : {0, 1}) {  // its columns have changed places
    const NodeId begin = before.sheet.vertices[turns[0].begin.index()].nodes[level],
                 end = before.sheet.vertices[turns[0].end.index()].nodes[level];
    EXPECT_LE((positions[begin.index()] - before.rest_positions[end.index()]).norm(), 1e-9);
    EXPECT_LE((positions[end.index()] - before.rest_positions[begin.index()]).norm(), 1e-9);
  }
}

TEST(Exchange, RestShapesAreThoseOfTheCallerWithTheVolumeTheyHad) {
  Tissue tissue = tissue_from_prisms(honeycomb(5, 5, 8, 20), PolygonSplit::diagonals, 1);
  const Mat3 unstretch = Vec3(1.1, 0.9, 1).asDiagonal();
  std::vector<WallTurn> turns = possible_turns(tissue.sheet);
  turns.resize(1);
  Vectors positions = tissue.rest_positions;
  const double volume = rest_volume(tissue, tissue.cells[turns[0].left.index()]);
  turn_walls(tissue, turns, 3, positions, [&](CellId) { return unstretch; });
  const Cell& cell = tissue.cells[turns[0].left.index()];
  EXPECT_NEAR(rest_volume(tissue, cell), volume, 1e-9);
  const double factor = (cell.rest_shape[1] - cell.rest_shape[0]).norm() /
                        (unstretch * (positions[cell.corners[1].index()] - positions[cell.corners[0].index()])).norm();
  for (std::size_t i = 0; i < cell.corners.size(); ++i)
    EXPECT_LE((cell.rest_shape[i] - factor * unstretch * positions[cell.corners[i].index()]).norm(), 1e-9);
}

// Stops that divisions left in walls become corners where a wall turns.
TEST(Exchange, FollowsDivisions) {
  Tissue tissue = tissue_from_prisms(honeycomb(6, 6, 8, 20), PolygonSplit::diagonals, 1);
  divide(tissue, std::vector<CellCut>{{CellId(14), 0, 3}, {CellId(20), 1, 4}, {CellId(22), 0, 3}}, 0);
  Vectors positions = tissue.rest_positions;
  Random random(3);
  int count = 0;
  for (int round = 0; round < 12; ++round) {
    std::vector<WallTurn> turns = random_turns(tissue, 3, random);
    turned(tissue, turns, 3, positions);
    count += static_cast<int>(turns.size());
    expect_symmetric(tissue);
    EXPECT_NEAR(volume_of_cells(tissue, positions) / volume_inside_boundary(tissue, positions), 1, 1e-13);
    for (const WallTurn& turn : turns)
      for (const CellId cell : turn.cells())
        EXPECT_TRUE(!cell.valid() || std::ranges::all_of(tissue.sheet.cells[cell.index()].ring,
                                                         [](const Stop& stop) { return stop.at == 0; }));
    smooth(tissue, positions);
  }
  EXPECT_GT(count, 20);
}

TEST(Exchange, IsRefusedWhereItHasNoRule) {
  EXPECT_FALSE(why_unturnable(tissue_from_prisms(honeycomb(3, 3, 8, 20), PolygonSplit::diagonals, 1)));
  EXPECT_TRUE(why_unturnable(tissue_from_prisms(honeycomb(3, 3, 8, 20), PolygonSplit::kites, 1)));
  EXPECT_TRUE(why_unturnable(build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}})));
  // Two cells that would part at two rims; four cells at one vertex.
  EXPECT_TRUE(possible_turns(tissue_from_prisms(honeycomb(2, 1, 8, 20), PolygonSplit::diagonals, 1).sheet).empty());
  const BlockShape four{.length_um = 40, .width_um = 40, .cell_height_um = 40, .cells = {2, 2, 1}};
  EXPECT_TRUE(possible_turns(build_block(four).sheet).empty());
}

// Turns walls of the cell until three are left.
void bring_to_three_walls(Tissue& tissue, CellId cell, Vectors& positions) {
  while (tissue.cells[cell.index()].sides() > 3) {
    std::vector<WallTurn> turns = possible_turns(tissue.sheet);
    std::erase_if(turns, [&](const WallTurn& turn) { return turn.left != cell && turn.right != cell; });
    ASSERT_FALSE(turns.empty());
    turns.resize(1);
    turned(tissue, turns, 3, positions);
    ASSERT_EQ(turns.size(), 1u);
    smooth(tissue, positions);
  }
}

TEST(Extrusion, ClosesTheSheetOverTheCell) {
  for (const int layers : {1, 2}) {
    Tissue tissue = tissue_from_prisms(honeycomb(7, 7, 8, 20), PolygonSplit::diagonals, layers);
    tissue.regions["some"] = CellSet(49, false);
    for (const std::size_t c : {23, 24, 25}) tissue.regions["some"][c] = true;
    Vectors positions = tissue.rest_positions;
    const CellId cell(24);
    EXPECT_FALSE(can_leave(tissue.sheet, cell));
    bring_to_three_walls(tissue, cell, positions);
    ASSERT_TRUE(can_leave(tissue.sheet, cell));
    const Tissue before = tissue;
    std::vector<CellId> about, leaving = {cell};
    for (const Stop& stop : tissue.sheet.cells[24].ring)
      about.push_back(tissue.sheet.walls[stop.wall.index()].beyond(cell));
    const TissueChange change = take_out(tissue, leaving, positions, as_it_is);
    ASSERT_EQ(leaving.size(), 1u);
    EXPECT_EQ(tissue.cells.size(), 48u);
    EXPECT_EQ(tissue.free_node_count(), before.free_node_count() - 2 * (static_cast<std::size_t>(layers) + 1));
    EXPECT_EQ(change.node_origin.size(), tissue.free_node_count());
    EXPECT_EQ(change.origin.size(), 48u);
    EXPECT_EQ(std::ranges::count(change.origin, cell), 0);
    EXPECT_EQ(std::ranges::count(tissue.regions.at("some"), true), 2);
    expect_symmetric(tissue);
    EXPECT_NEAR(volume_of_cells(tissue, positions) / volume_inside_boundary(tissue, positions), 1, 1e-13);
    EXPECT_GT(worst_quality(tissue, change, positions), 0);
    for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
      const CellId was = change.origin[c];
      const bool is_beside = std::ranges::count(about, was) > 0;
      EXPECT_EQ(change.remeshed[c], is_beside);
      EXPECT_EQ(tissue.cells[c].sides() + (is_beside ? 1 : 0), before.cells[was.index()].sides());
      EXPECT_EQ(tissue.cells[c].lineage.id, before.cells[was.index()].lineage.id);
      EXPECT_NEAR(rest_volume(tissue, tissue.cells[c]) / rest_volume(before, before.cells[was.index()]), 1, 1e-12);
    }
    // Each pair of the three still meets, now at one vertex.
    const auto pairs = pairs_of(tissue);
    const auto now = [&](CellId was) {
      return CellId(static_cast<std::size_t>(std::ranges::find(change.origin, was) - change.origin.begin()));
    };
    for (const std::size_t i : {0, 1, 2})
      EXPECT_TRUE(pairs.contains(std::minmax(now(about[i]), now(about[(i + 1) % 3]))));
    for (std::size_t n = 0; n < tissue.free_node_count(); ++n)
      EXPECT_EQ(tissue.rest_positions[n], before.rest_positions[change.node_origin[n].index()]);
  }
}

// Where an image of a vertex is a corner, too.
TEST(Extrusion, FillsAPeriodicSheet) {
  const SheetShape shape{.length_um = 60, .width_um = 50, .is_periodic = {true, true}};
  int count = 0;
  for (const std::size_t c : {0, 7, 19, 31}) {
    Tissue tissue = build_sheet(shape, 60, 1, cells_of_diagonals);
    Vectors positions = tissue.rest_positions;
    bring_to_three_walls(tissue, CellId(c), positions);
    if (!can_leave(tissue.sheet, CellId(c))) continue;
    std::vector<CellId> leaving = {CellId(c)};
    take_out(tissue, leaving, positions, as_it_is);
    if (leaving.empty()) continue;
    ++count;
    expect_symmetric(tissue);
    Random random(2);
    for (Vec3& x : positions) x += random.vector(0.1).cwiseProduct(Vec3(1, 1, 0));
    tissue.place_hanging_positions(positions);
    EXPECT_NEAR(volume_of_cells(tissue, positions), 60 * 50 * 10, 1e-8);
  }
  EXPECT_GE(count, 3);
}

}  // namespace
