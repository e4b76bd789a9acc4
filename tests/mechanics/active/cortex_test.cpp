#include "mechanics/active/cortex.hpp"

#include <fmt/format.h>

#include "mechanics/active/shape_activation.hpp"
#include "mechanics/division.hpp"
#include "mechanics/energy.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/cortices.hpp"
#include "support/divided.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"
#include "support/ran.hpp"

namespace {

CellSet all_cells(const Tissue& tissue) { return CellSet(tissue.cells.size(), true); }

TEST(Cortex, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 2, 3);
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    check_derivatives(Cortex(tissue, all_cells(tissue), whole_cortex(side)), tissue, 2);
    check_semidefinite_tangent(Cortex(tissue, all_cells(tissue), whole_cortex(side)), tissue, 2, true);
  }
  // Without flow, and with nothing but a tension.
  CortexRule rule = whole_cortex(CellSide::lateral);
  rule.relaxation_s = 0;
  check_derivatives(Cortex(tissue, all_cells(tissue), rule), tissue, 2);
  check_derivatives(Cortex(tissue, all_cells(tissue), {.side = CellSide::apical, .tension = 1}), tissue, 2);
}

// A law keeps the tensions of its last iterate; no other iterate sees them.
TEST(Cortex, WhatItKeepsIsOfTheSameIterate) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 2, 3);
  const Cortex law(tissue, all_cells(tissue), whole_cortex(CellSide::lateral));
  const Vectors direction = Random(1).vectors(tissue.node_count());
  int cases = 0;
  const auto expect_as_new = [&](const Step& step) {
    const Cortex fresh(tissue, all_cells(tissue), whole_cortex(CellSide::lateral));
    for (int again = 0; again < 2; ++again) {
      Vectors product(direction.size(), Vec3::Zero()), forces = product, of_fresh = product, forces_of_fresh = product;
      law.add_tangent_product(step, direction, product);
      law.add_forces(step, forces);
      fresh.add_tangent_product(step, direction, of_fresh);
      fresh.add_forces(step, forces_of_fresh);
      EXPECT_EQ(product, of_fresh) << "case " << cases;
      EXPECT_EQ(forces, forces_of_fresh) << "case " << cases;
    }
    ++cases;
  };
  Motion motion = random_motion(tissue, 2, 4);
  motion.internal = law.first_internal(tissue);
  const Step step = motion.step();
  expect_as_new(step);
  Step other = step;
  other.end_time_s += 0.5;
  expect_as_new(other);
  other = step;
  other.rate_s *= 2;
  expect_as_new(other);
  other = step;
  other.semidefinite_tangent = true;
  expect_as_new(other);
  motion.internal.front() *= 1.1;
  expect_as_new(motion.step());
  motion.positions[5].x() += 1e-9;
  expect_as_new(motion.step());
  EXPECT_EQ(cases, 6);
}

// Against the area as the rest of plica has it: T dA/dx by differences, with any kernels, any number of faces.
TEST(Cortex, EveryInstructionSetHasTheSameAreas) {
  for (const int cells : {1, 3, 9, 21}) {
    const Tissue tissue = distorted_block(
        {.length_um = 20.0 * cells, .width_um = 20, .cell_height_um = 30, .cells = {cells, 1, 1}}, 3, 5);
    const Motion motion = random_motion(tissue, 3, 8);
    Vectors expected;
    for (const Kernels kernels : available_kernels()) {
      const Cortex law(tissue, all_cells(tissue), {.side = CellSide::lateral, .tension = 1, .saturation = 0.2},
                       kernels);
      const std::vector<double> areas = law.areas(motion.positions);
      ASSERT_EQ(law.faces().size(), static_cast<std::size_t>(3 * cells + 1));
      for (std::size_t f = 0; f < areas.size(); ++f) {
        std::array<Vec3, 4> corners;
        for (int i = 0; i < 4; ++i) corners[i] = motion.positions[law.faces()[f].nodes[i].index()];
        EXPECT_NEAR(areas[f], facet_area(corners), 1e-12 * areas[f]) << name(kernels);
      }
      const Vectors forces = forces_of(law, motion.step());
      if (expected.empty()) expected = forces;
      for (std::size_t n = 0; n < forces.size(); ++n)
        EXPECT_LE((forces[n] - expected[n]).norm(), 1e-13 * largest(expected)) << name(kernels);
    }
  }
}

// A corner that is pulled across its face: where the face folds over, one Gauss point after the other has no area. The
// force stays that of the energy, and changes by little from place to place: else Newton's method would go round and
// round there.
TEST(Cortex, AFaceThatFoldsOverPullsWithoutAJump) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 30, .cells = {1, 1, 1}});
  for (const Kernels kernels : available_kernels()) {
    const Cortex law(tissue, all_cells(tissue), {.side = CellSide::apical, .tension = 1}, kernels);
    Motion motion = at_rest(tissue);
    const auto& corners = law.faces().front().nodes;
    const std::size_t moved = corners[2].index();
    const Vec3 from = motion.positions[moved], to = motion.positions[corners[0].index()] + Vec3(-15, -12, 0);
    constexpr int places = 1000;
    constexpr double apart = 1e-5;
    double before = 0, largest_jump = 0;
    for (int k = 0; k <= places; ++k) {
      const auto energy = [&](double part) {
        motion.positions[moved] = from + part * (to - from);
        return law.energy(motion.step());
      };
      const double part = static_cast<double>(k) / places;
      const double slope = (energy(part + apart) - energy(part - apart)) / (2 * apart);
      (void)energy(part);
      const double pull = forces_of(law, motion.step())[moved].dot(to - from);
      EXPECT_NEAR(pull, -slope, 1e-5 * 400) << part << " " << name(kernels);
      if (k > 0) largest_jump = std::max(largest_jump, std::abs(pull - before));
      before = pull;
    }
    EXPECT_LT(largest_jump, 30) << name(kernels);  // of a force times a way that goes from 350 to -350
    for (const double part : {0.4, 0.45, 0.5, 0.55, 0.6, 0.65, 0.7}) {
      motion.positions[moved] = from + part * (to - from);
      Vectors direction(tissue.node_count(), Vec3::Zero());
      direction[moved] = to - from;
      direction[corners[1].index()] = {3, 2, 4};
      Motion ahead = motion, behind = motion;
      for (std::size_t n = 0; n < direction.size(); ++n) {
        ahead.positions[n] += apart * direction[n];
        behind.positions[n] -= apart * direction[n];
      }
      const Vectors f = forces_of(law, ahead.step()), g = forces_of(law, behind.step());
      Vectors product(tissue.node_count(), Vec3::Zero());
      law.add_tangent_product(motion.step(), direction, product);
      for (std::size_t n = 0; n < product.size(); ++n)
        EXPECT_LT((product[n] - (g[n] - f[n]) / (2 * apart)).norm(), 1e-3) << part << " " << name(kernels);
    }
  }
}

// A wall is one face, with half of each cell's strength; at a border of the region with half, at a rim with all.
TEST(Cortex, AWallHasHalfOfEachOfItsCells) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 20, .cell_height_um = 30, .cells = {3, 1, 1}});
  CellSet first(3, false);
  first[0] = true;
  const Cortex law(tissue, first, {.side = CellSide::lateral, .tension = 2});
  const std::vector<double> tensions = law.tensions(at_rest(tissue).step());
  ASSERT_EQ(law.faces().size(), 4u);  // its own rim and two sides, and the wall to the second
  int shared = 0;
  for (std::size_t f = 0; f < tensions.size(); ++f) {
    EXPECT_DOUBLE_EQ(tensions[f], law.faces()[f].beyond ? 1 : 2);
    shared += law.faces()[f].beyond.has_value();
  }
  EXPECT_EQ(shared, 1);
}

// An endless embryo has one wall across for each cell along, however many cells its slice is long.
TEST(Cortex, ASliceHasHalfOfTheWallsAtItsEnds) {
  const auto energy = [](int cells) {
    const Tissue tissue = build_slice({.length_um = 7.0 * cells,
                                       .diameter_um = 180,
                                       .cell_height_um = 35,
                                       .cells = {cells, 8, 8},
                                       .elements_per_cell = {1, 1, 2}});
    const Cortex law(tissue, all_cells(tissue), {.side = CellSide::lateral, .tension = 2});
    return law.energy(at_rest(tissue).step());
  };
  EXPECT_NEAR(energy(3), 3 * energy(1), 1e-9 * energy(3));
}

// A flat sheet pulls at its held ends with tension times width, however fine, whatever its cells' size.
TEST(Cortex, ASheetPullsWithTensionTimesWidth) {
  for (const int cells : {1, 4}) {
    const Tissue tissue =
        build_block({.length_um = 60, .width_um = 24, .cell_height_um = 10, .cells = {3 * cells, cells, 1}});
    const Cortex law(tissue, all_cells(tissue), {.side = CellSide::apical, .tension = 0.8});
    const Vectors forces = forces_of(law, at_rest(tissue).step());
    double pull = 0, end = 0;
    for (const Vec3& x : tissue.rest_positions) end = std::max(end, x.x());
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (tissue.rest_positions[n].x() > end - 1e-9) pull -= forces[n].x();
    EXPECT_NEAR(pull, 0.8 * 24, 1e-12);
  }
}

// Saturation: half the tension at A = A_s, less on smaller faces. A face that has vanished is rounded off to a fiftieth
// of its area. Crowding pushes.
TEST(Cortex, TensionFollowsTheArea) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 10, .cells = {1, 1, 1}});
  const auto tension = [&](const CortexRule& rule, double ratio) {
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x.x() *= ratio;
    return Cortex(tissue, all_cells(tissue), rule).tensions(motion.step()).front();
  };
  EXPECT_NEAR(tension({.tension = 2, .saturation = 0.25}, 0.25), 1, 1e-12);
  EXPECT_NEAR(tension({.tension = 2, .saturation = 0.25}, 0.06), 2 * 0.06 / 0.31, 1e-12);
  EXPECT_NEAR(tension({.tension = 2, .saturation = 0.25}, 0), 2 * 0.01875 / 0.26875, 1e-12);
  EXPECT_NEAR(tension({.stiffness = 3}, 1.5), 1.5, 1e-12);
  EXPECT_NEAR(tension({.stiffness = 3}, 0.5), -1.5, 1e-12);
  EXPECT_NEAR(tension({.stiffness = 3, .compression_ratio = 0.1}, 0.5), -0.15, 1e-12);
  EXPECT_NEAR(tension({.crowding = 0.01}, 0.5), -0.04, 1e-12);
}

// A face that is held stretched: its elastic tension decays as a Maxwell element's, k (A/A_0 - 1) with dA_0/dt =
// (A - A_0)/tau.
TEST(Cortex, TensionDecaysAtConstantArea) {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}}));
  model.laws.push_back(std::make_unique<Cortex>(
      model.tissue, all_cells(model.tissue), CortexRule{.side = CellSide::apical, .stiffness = 3, .relaxation_s = 10}));
  for (auto& held : model.held) held = {true, true, true};
  const Law& law = *model.laws.front();
  // At rest the area is that of the face; the law starts with a stress-free area of half of it.
  for (const TimeOrder order : {TimeOrder::first, TimeOrder::second}) {
    std::vector<double> internal = {0.5, 0.5};
    const double h = order == TimeOrder::first ? 0.001 : 0.01;
    const Motion still = at_rest(model.tissue);
    for (int k = 0; k < std::lround(10 / h); ++k) {
      Step step = still.step();
      step.rate_s = order == TimeOrder::first || k == 0 ? h : 2 * h / 3;
      step.ahead = order == TimeOrder::first || k == 0 ? 0 : 1.0 / 3;
      step.internal = internal;
      internal = law.next_internal(step);
    }
    EXPECT_NEAR((1 - internal[0]) / 0.5, std::exp(-1.0), order == TimeOrder::first ? 2e-4 : 2e-5);
  }
}

// Cutting cells changes nothing but the meshes: energies, tensions and resultants are what they were.
TEST(Cortex, IsHandedOnToDaughters) {
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    Tissue tissue = build_block({.length_um = 60, .width_um = 60, .cell_height_um = 30, .cells = {3, 3, 1}});
    CellSet cells = all_cells(tissue);
    cells[2] = false;
    const Cortex before(tissue, cells, whole_cortex(side));
    std::vector<double> internal = before.first_internal(tissue);
    for (double& strain : internal) strain *= 0.9;
    Motion motion = at_rest(tissue);
    motion.internal = internal;
    const double energy = before.energy(motion.step());
    const std::vector<CellCut> cuts = {{CellId(4), 0}, {CellId(7), 1}};
    const TissueChange division = divide(tissue, cuts, 0);
    const auto after = before.after_change(tissue, division, tissue.rest_positions);
    Motion now = at_rest(tissue);
    now.internal = before.internal_after_change(internal, tissue, division, {});
    const auto& faces = static_cast<const Cortex&>(*after).faces();
    ASSERT_EQ(now.internal.size(), 2 * faces.size());
    // Walls between daughters are new.
    double of_new = 0;
    if (side == CellSide::lateral) {
      for (std::size_t f = 0; f < faces.size(); ++f)
        if (faces[f].beyond && division.origin[faces[f].cell.index()] == division.origin[faces[f].beyond->index()]) {
          EXPECT_DOUBLE_EQ(now.internal[f], 1);
          ++of_new;
        }
      EXPECT_EQ(of_new, 2);
      continue;
    }
    EXPECT_NEAR(after->energy(now.step()), energy, 1e-12 * std::abs(energy));
  }
}

// A wall between daughters of a stretched cell begins without tension, at the area it has then, also when it is cut
// itself; other faces keep theirs.
TEST(Cortex, AWallBetweenDaughtersBeginsAtItsArea) {
  for (const double relaxation_s : {0.0, 60.0}) {
    Model model(build_block({.length_um = 60, .width_um = 60, .cell_height_um = 30, .cells = {3, 3, 1}}));
    const CortexRule rule{.side = CellSide::lateral, .stiffness = 2, .relaxation_s = relaxation_s};
    model.laws.push_back(std::make_unique<Cortex>(model.tissue, all_cells(model.tissue), rule));
    State state = rest_state(model);
    for (Vec3& x : state.positions) x = {0.9 * x.x(), 0.9 * x.y(), 1.5 * x.z()};
    const double before = 2 * (0.9 * 1.5 - 1);
    const auto expect = [&](std::size_t new_walls) {
      const auto& law = static_cast<const Cortex&>(*model.laws.front());
      const Vectors no_velocity(state.positions.size(), Vec3::Zero());
      Step step = motionless(state, no_velocity);
      step.internal = state.internals.front();
      const std::vector<double> tensions = law.tensions(step);
      std::size_t without = 0;
      for (const double tension : tensions) {
        EXPECT_NEAR(tension, std::abs(tension) < 1e-6 ? 0 : before, 1e-6) << relaxation_s;
        without += std::abs(tension) < 1e-6 ? 1 : 0;
      }
      EXPECT_EQ(without, new_walls);
    };
    expect(0);
    divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(4), 0}, 0, 0.5}});
    expect(1);
    divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(4), 1}, 0, 0.5}});
    expect(3);  // the first wall in two parts, and another
  }
}

using Kind = ShapeActivationRule::Kind;

// Three cells in a row, apices on top.
Tissue row() { return build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}}); }

TEST(ShapeActivation, MeasuresAreOverThoseAtRest) {
  const Tissue tissue = row();
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = Vec3(x.x() * (x.z() > 0 ? 0.5 : 2), x.y(), 1.25 * x.z());
  const auto middle = [&](ShapeMeasure measure, std::span<const Vec3> at) {
    return ShapeActivation(tissue, {Kind::follows, measure}).ratios(at)[1];
  };
  for (const ShapeMeasure measure : {ShapeMeasure::apical_area_ratio, ShapeMeasure::basal_area_ratio,
                                     ShapeMeasure::height_ratio, ShapeMeasure::apical_stretch})
    EXPECT_DOUBLE_EQ(middle(measure, tissue.rest_positions), 1);
  EXPECT_DOUBLE_EQ(middle(ShapeMeasure::apical_area_ratio, positions), 0.5);
  EXPECT_DOUBLE_EQ(middle(ShapeMeasure::basal_area_ratio, positions), 2);
  const double slanted = std::hypot(50, 15) / 40;  // of its edges: 10 um out at the base became 20, at the apex 5
  EXPECT_NEAR(middle(ShapeMeasure::height_ratio, positions), slanted, 1e-12);
}

// However it is turned, and along no axis: a simple shear by s stretches by (s + sqrt(s^2 + 4))/2.
TEST(ShapeActivation, StretchIsAlongTheDirectionOfTheLargest) {
  const Tissue tissue = row();
  const ShapeActivation state(tissue, {Kind::follows, ShapeMeasure::apical_stretch});
  const double s = 0.6;
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = turn * Vec3(x.x() + s * x.y(), x.y(), x.z());
  for (const double stretch : state.ratios(positions)) EXPECT_NEAR(stretch, (s + std::sqrt(s * s + 4)) / 2, 1e-12);
}

TEST(ShapeActivation, StartsOnceAndRemembersWhen) {
  const Tissue tissue = row();
  const ShapeActivation state(tissue, {.kind = Kind::starts_below, .threshold = 0.8});
  Vectors smaller = tissue.rest_positions;
  for (Vec3& x : smaller)
    if (x.x() > 20) x.x() -= 8;  // the last cell's apex has 0.6 of its area
  const double no = ShapeActivation::not_yet;
  const std::vector<double> before = state.internal(tissue.rest_positions, 0, {});
  EXPECT_EQ(before, (std::vector<double>{no, no, no}));
  const std::vector<double> then = state.internal(smaller, 30, before);
  EXPECT_EQ(then, (std::vector<double>{no, no, 30}));
  EXPECT_EQ(state.internal(tissue.rest_positions, 60, then), then);
  // Or at the crossing: the apex has 0.8 of its area after half of the step from 20 s to 30 s.
  ShapeActivation at_crossing = state;
  at_crossing.start_at_crossing();
  const Step step{.positions = smaller,
                  .previous_positions = tissue.rest_positions,
                  .previous_velocities = {},
                  .rate_s = 10,
                  .end_time_s = 30};
  EXPECT_NEAR(at_crossing.after(step, before)[2], 25, 1e-9);
  EXPECT_EQ(at_crossing.after(step, then), then);
  EXPECT_EQ(
      ShapeActivation(tissue, {.kind = Kind::starts_above, .threshold = 0.5}).internal(tissue.rest_positions, 0, {}),
      (std::vector<double>{0, 0, 0}));
}

TEST(ShapeActivation, FollowsBetweenTwoValues) {
  const Tissue tissue = row();
  Vectors smaller = tissue.rest_positions;
  for (Vec3& x : smaller) x.x() *= 0.7;
  const auto followed = [&](double from, double to) {
    return ShapeActivation(tissue, {.kind = Kind::follows, .from = from, .to = to}).internal(smaller, 5, {})[0];
  };
  EXPECT_NEAR(followed(1, 0.4), 0.5, 1e-12);
  EXPECT_EQ(followed(1, 0.8), 1);
  EXPECT_EQ(followed(0.6, 0.2), 0);
  EXPECT_NEAR(followed(0.4, 1), 0.5, 1e-12);
}

// Three cells in a row, of which the last has 0.6 of its area.
TEST(ShapeActivation, ReadsTheMeanOfNeighbours) {
  const Tissue tissue = row();
  Vectors smaller = tissue.rest_positions;
  for (Vec3& x : smaller)
    if (x.x() > 20) x.x() -= 8;
  ShapeActivationRule rule{.kind = Kind::follows, .from = 1, .to = 0, .of_neighbours = true};
  const auto expect = [&](const std::vector<double>& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t c = 0; c < found.size(); ++c) EXPECT_NEAR(found[c], expected[c], 1e-12) << c;
  };
  expect(ShapeActivation(tissue, rule).internal(smaller, 0, {}), {0, 0.2, 0});
  rule.signal = 0;
  expect(ShapeActivation(tissue, rule).of_signals(std::vector<CellArray>{{1, 0.5, 0.2}}, 0, {}), {0.5, 0.4, 0.5});
  rule = {.kind = Kind::starts_below, .threshold = 0.9, .of_neighbours = true};
  expect(ShapeActivation(tissue, rule).internal(smaller, 30, {}), {-1, 30, -1});
}

// A wall pulls by what each of its cells has come to; a cell that has not begun leaves its half out.
TEST(ShapeActivation, ACortexActsFromItsCellsStart) {
  const Tissue tissue = row();
  const CortexRule rule{.side = CellSide::apical,
                        .tension = 2,
                        .stiffness = 0.5,
                        .program = Program({0, 10}, {0, 1}),
                        .stiffness_program = Program({0, 10}, {1, 0}),
                        .activation = {.kind = Kind::starts_below, .threshold = 0.8}};
  const Cortex law(tissue, CellSet(3, true), rule);
  Motion motion = at_rest(tissue);
  motion.internal = law.first_internal(tissue);
  ASSERT_EQ(motion.internal.size(), 3u);
  motion.internal[1] = 100;
  motion.end_time_s = 105;
  EXPECT_EQ(law.tensions(motion.step()), (std::vector<double>{0, 1, 0}));
  EXPECT_EQ(law.activity_of(CellId(1), 105, motion.internal), 0.5);
  EXPECT_EQ(law.activity_of(CellId(0), 105, motion.internal), 0);
  for (Vec3& x : motion.positions) x.x() *= 1.1;
  const std::vector<double> stretched = law.tensions(motion.step());
  EXPECT_NEAR(stretched[0], 0.5 * 0.1, 1e-12);
  EXPECT_NEAR(stretched[1], 1 + 0.5 * 0.5 * 0.1, 1e-12);
  expect_forces_are_minus_energy_gradient(law, motion, 1e-6);
  expect_tangent_is_minus_force_gradient(law, motion, 1e-6);
  EXPECT_TRUE(law.program_points_s().empty());

  CortexRule following = rule;
  following.activation = {.kind = Kind::follows, .from = 1, .to = 0.5};
  const Cortex follower(tissue, CellSet(3, true), following);
  motion = at_rest(tissue);
  motion.internal = {0, 0.25, 1};
  motion.end_time_s = 10;
  EXPECT_EQ(follower.tensions(motion.step()), (std::vector<double>{0, 0.5, 2}));
}

// Contraction that is shut off early lets the furrow go, later it goes on, if walls and floor wait for their own cell.
TEST(ShapeActivation, DecidesWhatTheClockDoesNot) {
  const auto depth_um = [](double off_min) {
    Simulation simulation(load_scenario(
        find_scenario("furrow-slice"),
        {fmt::format("cortex.apical.program.time_min=[0, {}, {}]", off_min, off_min + 0.5),
         fmt::format("cortex.apical.program.activity=[0, {}, 0]", off_min / 9),
         "cortex.shortening.program.time_min=[0, 11]", "cortex.shortening.trigger.measure=apical_area_ratio",
         "cortex.shortening.trigger.below=0.3", "cortex.floor.stiffness_program.time_min=[0, 7]",
         "cortex.floor.trigger.measure=apical_area_ratio", "cortex.floor.trigger.below=0.3"}));
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
    return *simulation.measures()["furrow_depth_um"];
  };
  EXPECT_LT(depth_um(3), 5);
  EXPECT_GT(depth_um(8), 40);
}

// When each cell began, who touches whom and rest areas that flow are part of what a run remembers.
TEST(ShapeActivation, ARunGoesOnToTheSameBits) {
  const Scenario scenario = load_scenario(
      find_scenario("furrow-slice"),
      {"cortex.shortening.program.time_min=[0, 11]", "time.end_min=17.8",
       "cortex.shortening.trigger.measure=apical_area_ratio", "cortex.shortening.trigger.below=0.3",
       "cortex.surface.tension_mN_per_m=0.01", "cortex.surface.follow.measure=height_ratio",
       "cortex.surface.follow.of=neighbours", "cortex.surface.follow.from=1", "cortex.surface.follow.to=1.5",
       "cortex.felt={region=\"all\", tension_mN_per_m=0.1, follow={measure=\"stress_Pa\", from=0, to=20}}"});
  Simulation whole(scenario);
  std::optional<RunMemory> kept;
  while (whole.step())
    if (*whole.measures()["contact_pairs"] > 2 && !kept) kept = whole.memory();
  ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  ASSERT_TRUE(kept);
  Simulation rest(scenario);
  rest.go_on_from(*kept);
  rest.run();
  EXPECT_GT(whole.steps(), kept->steps);
  EXPECT_EQ(rest.state().positions, whole.state().positions);
  EXPECT_EQ(rest.state().internals, whole.state().internals);
}

}  // namespace
