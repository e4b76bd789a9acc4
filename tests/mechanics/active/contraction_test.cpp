// Apical and basal contraction: springs, programs and tensions.
#include "mechanics/active/contraction.hpp"

#include <functional>

#include "mechanics/active/program.hpp"
#include "support/law_checks.hpp"
#include "tissue/mirror.hpp"

namespace {

const BlockShape refined{
    .length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}, .elements_per_cell = {2, 2, 1}};

Contraction law_of(const Tissue& tissue, const ContractionRule& rule, Program program = {}) {
  return {contraction_springs(tissue, CellSet(tissue.cells.size(), true), rule), std::move(program)};
}

/// Two nodes on the x axis, `length_um` apart now and `previous_um` at the beginning of the step.
Motion pair(double length_um, double previous_um = 0) {
  Motion motion;
  motion.positions = {Vec3::Zero(), Vec3(length_um, 0, 0)};
  motion.previous_positions = {Vec3::Zero(), Vec3(previous_um > 0 ? previous_um : length_um, 0, 0)};
  motion.previous_velocities.assign(2, Vec3::Zero());
  return motion;
}

TEST(Contraction, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 1, 1);
  check_derivatives(law_of(tissue, {.stiffness = 7.3, .across_ratio = 0.4}), tissue, 3);
}

TEST(Contraction, DerivativesAgreeWithFiniteDifferencesWithEverythingOn) {
  const Tissue tissue = distorted_block(two_cells, 1, 2);
  check_derivatives(law_of(tissue,
                           {.stiffness = 7.3,
                            .across_ratio = 0.4,
                            .diagonals = true,
                            .rest_length_ratio = 0.6,
                            .preload = 5,
                            .damping = 2},
                           Program({0, 2}, {0, 1})),
                    tissue, 3);
}

TEST(Contraction, DerivativesOfARunAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 1, 2);
  const ContractionRule rule{
      .stiffness = 7.3, .across_ratio = 0.4, .diagonals = true, .rest_length_ratio = 0.6, .preload = 5, .damping = 2};
  check_law_derivatives(law_of(tissue, rule, Program({0, 2}, {0, 1})), tissue, 3, {});
}

// Chains: edges into which cuts have put nodes.
TEST(Contraction, DerivativesAgreeWithFiniteDifferencesOnChains) {
  const Tissue tissue = distorted_block(refined, 1, 3);
  std::vector<Spring> springs;
  for (const Cell& cell : tissue.cells)
    for (const CellLine& line : cell.lines)
      if (line.chain.nodes.size() > 2) springs.push_back({line.chain.nodes, 2, 3, 1, 10});
  ASSERT_EQ(springs.size(), 24u);
  check_derivatives(Contraction(std::move(springs), {}), tissue, 2, 2);
}

TEST(Contraction, SemidefiniteTangentLeavesOutTheTurningOfSpringsThatPush) {
  const Tissue tissue = distorted_block(two_cells, 1, 5);
  check_semidefinite_tangent(law_of(tissue, {.stiffness = 1, .preload = -60}), tissue, 3, true);
  check_semidefinite_tangent(law_of(tissue, {.stiffness = 1, .preload = 60}), tissue, 3, false);
}

TEST(Contraction, TensionIsStiffnessTimesStretchPlusPreload) {
  const Contraction law({Spring{{NodeId(0), NodeId(1)}, 3, 5, 0, 12}}, {});
  const Motion motion = pair(20);
  const Vectors forces = forces_of(law, motion.step());
  EXPECT_DOUBLE_EQ(forces[0].x(), 3 * (20 - 12) + 5);
  EXPECT_DOUBLE_EQ(forces[1].x(), -(3 * (20 - 12) + 5));
  EXPECT_EQ(forces[1].y(), 0);
}

TEST(Contraction, SlackSpringPullsWithItsPreloadOnly) {
  const Contraction law({Spring{{NodeId(0), NodeId(1)}, 3, 5, 0, 30}}, {});
  EXPECT_DOUBLE_EQ(forces_of(law, pair(20).step())[0].x(), 5);
}

TEST(Contraction, DampingResistsTheRateOfLengtheningWhateverTheActivity) {
  const Contraction law({Spring{{NodeId(0), NodeId(1)}, 3, 5, 4, 0}}, Program({0}, {0}));
  Motion motion = pair(20, 18);
  motion.rate_s = 0.5;
  EXPECT_DOUBLE_EQ(forces_of(law, motion.step())[0].x(), 4 * (20 - 18) / 0.5);
  motion.earlier_positions = pair(17).positions;
  motion.ahead = 0.25;
  EXPECT_DOUBLE_EQ(forces_of(law, motion.step())[0].x(), 4 * (20 - (18 + 0.25 * (18 - 17))) / 0.5);
}

TEST(Contraction, ActivityIsReadAtTheEndOfTheStep) {
  const Contraction law({Spring{{NodeId(0), NodeId(1)}, 3, 5, 0, 0}}, Program({1, 3}, {0.2, 1.0}));
  Motion motion = pair(20);
  for (const auto& [time, activity] : {std::pair{0.0, 0.2}, {1.0, 0.2}, {2.0, 0.6}, {3.0, 1.0}, {9.0, 1.0}}) {
    motion.end_time_s = time;
    EXPECT_NEAR(forces_of(law, motion.step())[0].x(), activity * 65, 1e-12);
  }
}

// A wave: the program of a spring starts when its delay is over, and the spring is slack before, whatever its first
// point.
TEST(Contraction, DelayedSpringStartsItsProgramLater) {
  const Contraction step_on({Spring{{NodeId(0), NodeId(1)}, 3, 5, 0, 0, 10}}, {});
  const Contraction ramp({Spring{{NodeId(0), NodeId(1)}, 3, 5, 0, 0, 10}}, Program({0, 4}, {0.5, 1.0}));
  Motion motion = pair(20);
  for (const auto& [time, on, ramped] : {std::tuple{0.0, 0.0, 0.0},
                                         {9.99, 0.0, 0.0},
                                         {10.0, 1.0, 0.5},
                                         {12.0, 1.0, 0.75},
                                         {14.0, 1.0, 1.0},
                                         {99.0, 1.0, 1.0}}) {
    motion.end_time_s = time;
    EXPECT_NEAR(forces_of(step_on, motion.step())[0].x(), on * 65, 1e-12) << time;
    EXPECT_NEAR(forces_of(ramp, motion.step())[0].x(), ramped * 65, 1e-12) << time;
    EXPECT_NEAR(ramp.program().delayed_at(10, time), ramped, 1e-12);
  }
}

TEST(Contraction, DerivativesAgreeWithFiniteDifferencesInAWave) {
  const Tissue tissue = distorted_block(two_cells, 1, 6);
  // At 1.3 s, when random_motion's step ends, one cell is in the middle of its program and one before its end.
  CellPattern pattern(CellSet(2, true));
  pattern.strengths = {1, 0.3};
  pattern.delays_s = {0.2, 0.8};
  check_derivatives(Contraction(contraction_springs(tissue, pattern, {.stiffness = 2, .preload = 3}),
                                Program({0, 1}, {0, 1}), pattern),
                    tissue, 3);
}

TEST(Contraction, PointsAreThoseOfTheProgramAfterEachDelay) {
  const auto points = [](const std::vector<double>& delays, Program program) {
    std::vector<Spring> springs;
    for (const double delay : delays) springs.push_back({{NodeId(0), NodeId(1)}, 1, 0, 0, 0, delay});
    return Contraction(std::move(springs), std::move(program)).program_points_s();
  };
  using Points = std::vector<double>;
  EXPECT_EQ(points({0, 0}, {}), (Points{0}));
  EXPECT_EQ(points({0}, Program({1, 5}, {0, 1})), (Points{1, 5}));
  EXPECT_EQ(points({7, 0, 7, 3}, {}), (Points{0, 3, 7}));
  EXPECT_EQ(points({0, 4, 10}, Program({1, 5}, {0, 1})), (Points{1, 5, 9, 11, 15}));
  // Many delays: about a hundred of them, and the last.
  Points many;
  for (int i = 0; i <= 1000; ++i) many.push_back(0.1 * i);
  const Points thinned = points(many, {});
  EXPECT_LE(thinned.size(), 102u);
  EXPECT_EQ(thinned.back(), 100);
  for (std::size_t i = 1; i < thinned.size(); ++i) EXPECT_LE(thinned[i] - thinned[i - 1], 1.11);
}

// An edge of two segments is one spring of their total length: at a straight middle node nothing pulls, at a bent one
// the tension of the whole length pulls both ways.
TEST(Contraction, ChainHasTheTensionOfItsTotalLength) {
  const Contraction law({Spring{{NodeId(0), NodeId(1), NodeId(2)}, 2, 0, 0, 10}}, {});
  Motion motion = pair(3);
  motion.positions = {Vec3(0, 0, 0), Vec3(6, 0, 0), Vec3(6, 9, 0)};
  motion.previous_positions = motion.positions;
  motion.previous_velocities.assign(3, Vec3::Zero());
  const Vectors forces = forces_of(law, motion.step());
  const double tension = 2 * (15 - 10);
  EXPECT_LE((forces[0] - tension * Vec3(1, 0, 0)).norm(), 1e-14);
  EXPECT_LE((forces[1] - tension * Vec3(-1, 1, 0)).norm(), 1e-14);
  EXPECT_LE((forces[2] - tension * Vec3(0, -1, 0)).norm(), 1e-14);
  motion.positions[2] = Vec3(15, 0, 0);
  EXPECT_LE(forces_of(law, motion.step())[1].norm(), 1e-14);
}

TEST(Contraction, NeighboursThatShareAnEdgeHaveASpringEach) {
  const Tissue tissue = build_block(two_cells);
  const std::vector<Spring> springs =
      contraction_springs(tissue, CellSet(2, true), {.stiffness = 1, .diagonals = true});
  EXPECT_EQ(springs.size(), 12u);  // four edges and two diagonals a cell
  // The shared apical edge runs across at x = 0.
  int shared = 0;
  for (const Spring& spring : springs) {
    const Vec3 a = tissue.rest_positions[spring.nodes.front().index()];
    const Vec3 b = tissue.rest_positions[spring.nodes.back().index()];
    shared += a.x() == 0 && b.x() == 0;
    EXPECT_EQ(a.z(), 20);
    EXPECT_EQ(b.z(), 20);
  }
  EXPECT_EQ(shared, 2);
}

TEST(Contraction, RatiosScaleStiffnessAndPreloadByDirection) {
  const Tissue tissue = build_block(two_cells);
  const ContractionRule rule{.stiffness = 2,
                             .along_ratio = 1.5,
                             .across_ratio = 0.4,
                             .diagonals = true,
                             .rest_length_ratio = 0.5,
                             .preload = 3};
  int along = 0, across = 0, diagonal = 0;
  for (const Spring& spring : contraction_springs(tissue, CellSet(2, true), rule)) {
    const Vec3 edge =
        tissue.rest_positions[spring.nodes.back().index()] - tissue.rest_positions[spring.nodes.front().index()];
    const bool runs_x = edge.x() != 0, runs_y = edge.y() != 0;
    const double factor = runs_x && runs_y ? 0.95 : runs_x ? 1.5 : 0.4;
    (runs_x && runs_y ? diagonal : runs_x ? along : across) += 1;
    EXPECT_NEAR(spring.stiffness, 2 * factor, 1e-14);
    EXPECT_NEAR(spring.preload, 3 * factor, 1e-14);
    EXPECT_NEAR(spring.rest_length, 0.5 * edge.norm(), 1e-13);
  }
  EXPECT_EQ(along, 4);
  EXPECT_EQ(across, 4);
  EXPECT_EQ(diagonal, 4);
}

// Refinement changes the error and not the model: the tension of a face's edges is spread over its lines, those on the
// rim with half a share, and the segments of a line are springs in series. What all cells do together costs the same.
TEST(Contraction, RefinedElementsKeepTheEnergyOfTheCells) {
  BlockShape shape{.length_um = 60, .width_um = 30, .cell_height_um = 40, .cells = {3, 2, 1}};
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    const ContractionRule rule{side, 2, 1.5, 0.4, false, 0.3, 1, 3};
    std::vector<double> energies;
    for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {5, 2, 3}}) {
      shape.elements_per_cell = elements;
      const Tissue tissue = build_block(shape);
      Motion motion = at_rest(tissue);
      for (Vec3& x : motion.positions) x = Vec3(0.8 * x.x() + 0.1 * x.y(), 0.7 * x.y() - 0.2 * x.x(), 0.6 * x.z());
      energies.push_back(law_of(tissue, rule).energy(motion.step()));
      EXPECT_GT(energies.front(), 0);
      EXPECT_NEAR(energies.back(), energies.front(), 1e-12 * energies.front());
    }
  }
}

// The tension at a point of the face follows the stretch there: an element edge that has shrunk alone pulls less than
// its neighbour. One tension all along would draw the elements where contractile cells end into nothing.
TEST(Contraction, PartOfALineThatHasShrunkPullsLess) {
  const Tissue tissue = build_block(
      {.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}, .elements_per_cell = {2, 1, 1}});
  Motion motion = at_rest(tissue);
  std::size_t moved = 0;  // the middle of an apical edge: 4 um along, so that its parts are 14 and 6 um long
  for (std::size_t n = 0; n < tissue.node_count(); ++n)
    if (tissue.rest_positions[n].isApprox(Vec3(0, 10, 20))) moved = n;
  motion.positions[moved].x() += 4;
  const Vectors forces = forces_of(law_of(tissue, {.stiffness = 3, .across_ratio = 0}), motion.step());
  EXPECT_NEAR(forces[moved].x(), 2 * 3 * (6 - 14), 1e-12);
}

// A sheet under uniform contraction pulls through every cut with one force, however its cells are divided.
TEST(Contraction, ResultantThroughACutDoesNotDependOnRefinement) {
  const ContractionRule rule{.stiffness = 2, .across_ratio = 0.4, .rest_length_ratio = 0.3, .preload = 1, .damping = 3};
  BlockShape shape{.length_um = 60, .width_um = 30, .cell_height_um = 40, .cells = {3, 2, 1}};
  // Cells are 20 x 15 um now; each was 1.1 times as long and 0.9 times as wide when the step began.
  Motion motion;
  const double along = 2 * (20 - 0.3 * 20) + 1 + 3 * (20 - 22) / motion.rate_s;
  const double across = 0.4 * (2 * (15 - 0.3 * 15) + 1) + 3 * (15 - 13.5) / motion.rate_s;
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {4, 2, 1}}) {
    shape.elements_per_cell = elements;
    const Tissue tissue = build_block(shape);
    motion = at_rest(tissue);
    for (Vec3& x : motion.previous_positions) x = x.cwiseProduct(Vec3(1.1, 0.9, 1));
    const Vectors forces = forces_of(law_of(tissue, rule), motion.step());
    // Two edges of each cell that the cut goes through pull at what lies behind it. 29 and 14: the last nodes alone.
    for (const auto& [axis, place, pull] : {std::tuple{0, -29.0, 4 * along},
                                            {0, 1.0, 4 * along},
                                            {0, 29.0, 4 * along},
                                            {1, -14.0, 6 * across},
                                            {1, 1.0, 6 * across},
                                            {1, 14.0, 6 * across}}) {
      Vec3 behind = Vec3::Zero(), expected = Vec3::Zero();
      for (std::size_t n = 0; n < forces.size(); ++n)
        if (tissue.rest_positions[n][axis] > place) behind += forces[n];
      expected[axis] = -pull;
      EXPECT_LE((behind - expected).norm(), 1e-12 * pull) << elements[0] << " elements, axis " << axis << ", " << place;
    }
  }
}

TEST(Contraction, SpringsHaveNoResultantAndNoTorque) {
  const Tissue tissue = distorted_block(refined, 1, 5);
  expect_no_resultant_and_no_torque(law_of(tissue, {.stiffness = 2, .diagonals = true, .preload = 1, .damping = 3}),
                                    tissue, 3);
}

TEST(Program, IsAlwaysOneByDefault) {
  for (const double time : {0.0, 1.0, 1e6}) EXPECT_EQ(Program().at(time), 1);
}

TEST(Program, IsLinearBetweenPointsAndHeldOutside) {
  const Program program({10, 20, 40}, {0.5, 1.0, 0.0});
  for (const auto& [time, activity] :
       {std::pair{0.0, 0.5}, {10.0, 0.5}, {12.0, 0.6}, {20.0, 1.0}, {30.0, 0.5}, {39.0, 0.05}, {40.0, 0.0}, {1e6, 0.0}})
    EXPECT_NEAR(program.at(time), activity, 1e-14) << "at " << time;
}

// At a jump the activity is still that before it: a step that ends there is not yet of the new one.
TEST(Program, JumpsBetweenTwoPointsOfOneTime) {
  const Program program({0, 0, 10, 20, 20}, {0.2, 0.4, 1.0, 1.0, 0.1});
  for (const auto& [time, activity] : {std::pair{0.0, 0.2},
                                       {0.001, 0.40006},
                                       {5.0, 0.7},
                                       {10.0, 1.0},
                                       {20.0, 1.0},
                                       {20 + 1e-9, 1.0},  // rounding of the clock
                                       {20 + 1e-5, 0.1},
                                       {1e6, 0.1}})
    EXPECT_NEAR(program.at(time), activity, 1e-14) << "at " << time;
  EXPECT_EQ(program.jumps_s(), (std::vector<double>{0, 20}));
  EXPECT_TRUE(Program({10, 20, 40}, {0.5, 1.0, 0.0}).jumps_s().empty());
}

TEST(Program, OnePointHoldsForEver) {
  const Program program({5}, {0.3});
  for (const double time : {0.0, 5.0, 6.0}) EXPECT_EQ(program.at(time), 0.3);
}

// The pull of all springs across the plane x = `at`, nN, and across y.
double pull_across(const Tissue& tissue, const std::vector<Spring>& springs, int axis, double at) {
  double pull = 0;
  for (const Spring& spring : springs) {
    const double from = tissue.rest_positions[spring.nodes.front().index()][axis],
                 to = tissue.rest_positions[spring.nodes.back().index()][axis];
    if ((from < at) != (to < at)) pull += spring.preload;
  }
  return pull;
}

TEST(Tension, IsThatOfTheWidthWhateverTheCells) {
  for (const std::array<int, 3> cells : {std::array{2, 3, 1}, {4, 3, 1}, {8, 5, 1}})
    for (const std::array<int, 3> elements : {std::array{1, 1, 1}, {2, 2, 1}, {3, 1, 2}})
      for (const CellSide side : {CellSide::apical, CellSide::basal}) {
        const Tissue sheet = build_block({80, 60, 20, cells, elements});
        const auto springs = contraction_springs(sheet, CellSet(sheet.cells.size(), true),
                                                 {.side = side, .across_ratio = 0.5, .tension = 1.5});
        EXPECT_NEAR(pull_across(sheet, springs, 0, 3.3), 1.5 * 60, 1e-9);
        EXPECT_NEAR(pull_across(sheet, springs, 1, 3.3), 0.5 * 1.5 * 80, 1e-9);
      }
}

// The walls of a cell have its perimeter for a width.
TEST(Tension, OfLateralFacesIsThatOfThePerimeter) {
  const Tissue sheet = build_block({80, 60, 20, {4, 3, 1}, {1, 1, 1}});
  const auto springs =
      contraction_springs(sheet, CellSet(sheet.cells.size(), true), {.side = CellSide::lateral, .tension = 2});
  EXPECT_NEAR(pull_across(sheet, springs, 2, 1.1), 12 * 2 * (4 * 20), 1e-9);
}

CellSet cells_where(const Tissue& tissue, const std::function<bool(const Vec3&)>& chosen) {
  CellSet cells;
  for (const Cell& cell : tissue.cells) cells.push_back(chosen(cell_centre(cell, tissue.rest_positions)));
  return cells;
}

// 2 x 2 of 4 x 4 cells: a cable of 8 edges of 20 x 15 um, on either side of the cells, however they are meshed.
TEST(Cable, PullsAlongTheBorderOnly) {
  BlockShape shape{.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 4, 1}};
  for (const std::array<int, 3>& elements : {std::array<int, 3>{1, 1, 1}, {2, 3, 2}}) {
    shape.elements_per_cell = elements;
    const Tissue tissue = build_block(shape);
    const CellSet inner =
        cells_where(tissue, [](const Vec3& x) { return std::abs(x.x()) < 20 && std::abs(x.y()) < 15; });
    const CellSet right = cells_where(tissue, [](const Vec3& x) { return x.x() > 0; });
    for (const CellSide side : {CellSide::apical, CellSide::basal}) {
      const auto cable = [&](const CellSet& beyond, double stiffness, double tension) {
        return Contraction(
            contraction_springs(
                tissue, inner,
                {.side = side, .stiffness = stiffness, .preload = tension, .border = OtherSide{beyond, true}}),
            {});
      };
      const CellSet all(tissue.cells.size(), true);
      Motion motion = at_rest(tissue);
      EXPECT_NEAR(cable(all, 0, 3).energy(motion.step()), 3 * (4 * 20 + 4 * 15), 1e-10);
      EXPECT_NEAR(cable(right, 0, 3).energy(motion.step()), 3 * (2 * 20 + 2 * 15), 1e-10);
      EXPECT_NEAR(cable(all, 2, 0).energy(motion.step()), 4 * (20 * 20 + 15 * 15), 1e-10);
      const Vectors forces = forces_of(cable(all, 0, 3), motion.step());
      for (std::size_t n = 0; n < forces.size(); ++n) {
        const Vec3& x = tissue.rest_positions[n];
        const bool on_side = x.z() == (side == CellSide::apical ? 20 : -20);
        const bool at_corner = on_side && std::abs(x.x()) == 20 && std::abs(x.y()) == 15;
        EXPECT_NEAR(forces[n].norm(), at_corner ? 3 * std::sqrt(2.0) : 0, 1e-12);
      }
    }
  }
}

// The perimeter; a mirror plane is no border of half of it.
TEST(Cable, RunsAlongAFreeRim) {
  const Tissue whole = build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 4, 1}});
  const auto energy = [](const Tissue& tissue, bool has_rim) {
    const CellSet all(tissue.cells.size(), true);
    return Contraction(contraction_springs(tissue, all, {.preload = 2, .border = OtherSide{all, has_rim}}), {})
        .energy(at_rest(tissue).step());
  };
  EXPECT_NEAR(energy(whole, true), 2 * 280, 1e-10);
  EXPECT_EQ(energy(whole, false), 0);
  EXPECT_NEAR(energy(side_of(whole, {false, true, false}).tissue, true), 280, 1e-10);
  EXPECT_NEAR(energy(side_of(whole, {true, true, false}).tissue, true), 140, 1e-10);
}

// A sheet that is rolled up about x: a cable round the tube presses inward at each node with 2 P sin(a/2), where it
// turns by a; times the nodes on a length, P/R of it.
TEST(Cable, PressesOnATubeByLaplacesLaw) {
  constexpr int around = 24;
  constexpr double radius = 50, width = 2 * std::numbers::pi * radius, turn = 2 * std::numbers::pi / around;
  const Tissue tissue =
      build_block({.length_um = 40, .width_um = width, .cell_height_um = 10, .cells = {4, around, 1}});
  const CellSet front = cells_where(tissue, [](const Vec3& x) { return x.x() > 0; });
  const Contraction cable(
      contraction_springs(tissue, front, {.preload = 0.8, .border = OtherSide{CellSet(front.size(), true), false}}),
      {});
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) {
    const double angle = x.y() / radius, at = radius + x.z() - 5;
    x = {x.x(), at * std::sin(angle), at * std::cos(angle)};
  }
  const Vectors forces = forces_of(cable, motion.step());
  int pressed = 0;
  for (std::size_t n = 0; n < forces.size(); ++n) {
    const Vec3 &X = tissue.rest_positions[n], &x = motion.positions[n];
    if (std::abs(X.y()) > 0.45 * width) continue;
    const bool on_cable = X.x() == 0 && X.z() > 0;
    pressed += on_cable ? 1 : 0;
    EXPECT_NEAR(-forces[n].dot(Vec3(0, x.y(), x.z()).normalized()), on_cable ? 1.6 * std::sin(turn / 2) : 0, 1e-12);
  }
  EXPECT_EQ(pressed, 21);
}

}  // namespace
