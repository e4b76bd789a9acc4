#include "mechanics/active/own_state.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "mechanics/active/cortex.hpp"
#include "mechanics/division.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;
using Kind = OwnStateRule::Kind;

// Three cells in a row, apices on top.
Tissue row() { return build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}}); }

TEST(OwnState, MeasuresAreOverThoseAtRest) {
  const Tissue tissue = row();
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = Vec3(x.x() * (x.z() > 0 ? 0.5 : 2), x.y(), 1.25 * x.z());
  const auto middle = [&](OwnMeasure measure, std::span<const Vec3> at) {
    return OwnState(tissue, {Kind::follows, measure}).ratios(at)[1];
  };
  for (const OwnMeasure measure : {OwnMeasure::apical_area_ratio, OwnMeasure::basal_area_ratio,
                                   OwnMeasure::height_ratio, OwnMeasure::apical_stretch})
    EXPECT_DOUBLE_EQ(middle(measure, tissue.rest_positions), 1);
  EXPECT_DOUBLE_EQ(middle(OwnMeasure::apical_area_ratio, positions), 0.5);
  EXPECT_DOUBLE_EQ(middle(OwnMeasure::basal_area_ratio, positions), 2);
  const double slanted = std::hypot(50, 15) / 40;  // of its edges: 10 um out at the base became 20, at the apex 5
  EXPECT_NEAR(middle(OwnMeasure::height_ratio, positions), slanted, 1e-12);
}

// However it is turned, and along no axis: a simple shear by s stretches by (s + sqrt(s^2 + 4))/2.
TEST(OwnState, StretchIsAlongTheDirectionOfTheLargest) {
  const Tissue tissue = row();
  const OwnState state(tissue, {Kind::follows, OwnMeasure::apical_stretch});
  const double s = 0.6;
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x = turn * Vec3(x.x() + s * x.y(), x.y(), x.z());
  for (const double stretch : state.ratios(positions)) EXPECT_NEAR(stretch, (s + std::sqrt(s * s + 4)) / 2, 1e-12);
}

TEST(OwnState, StartsOnceAndRemembersWhen) {
  const Tissue tissue = row();
  const OwnState state(tissue, {.kind = Kind::starts_below, .threshold = 0.8});
  Vectors smaller = tissue.rest_positions;
  for (Vec3& x : smaller)
    if (x.x() > 20) x.x() -= 8;  // the last cell's apex has 0.6 of its area
  const double no = OwnState::not_yet;
  const std::vector<double> before = state.numbers(tissue.rest_positions, 0, {});
  EXPECT_EQ(before, (std::vector<double>{no, no, no}));
  const std::vector<double> then = state.numbers(smaller, 30, before);
  EXPECT_EQ(then, (std::vector<double>{no, no, 30}));
  EXPECT_EQ(state.numbers(tissue.rest_positions, 60, then), then);
  EXPECT_EQ(OwnState(tissue, {.kind = Kind::starts_above, .threshold = 0.5}).numbers(tissue.rest_positions, 0, {}),
            (std::vector<double>{0, 0, 0}));
}

TEST(OwnState, FollowsBetweenTwoValues) {
  const Tissue tissue = row();
  Vectors smaller = tissue.rest_positions;
  for (Vec3& x : smaller) x.x() *= 0.7;
  const auto followed = [&](double from, double to) {
    return OwnState(tissue, {.kind = Kind::follows, .from = from, .to = to}).numbers(smaller, 5, {})[0];
  };
  EXPECT_NEAR(followed(1, 0.4), 0.5, 1e-12);
  EXPECT_EQ(followed(1, 0.8), 1);
  EXPECT_EQ(followed(0.6, 0.2), 0);
  EXPECT_NEAR(followed(0.4, 1), 0.5, 1e-12);
}

// A wall pulls by what each of its cells has come to; a cell that has not begun leaves its half out.
TEST(OwnState, ACortexActsFromItsCellsStart) {
  const Tissue tissue = row();
  const CortexRule rule{.side = CellSide::apical,
                        .tension = 2,
                        .stiffness = 0.5,
                        .program = Program({0, 10}, {0, 1}),
                        .stiffness_program = Program({0, 10}, {1, 0}),
                        .own = {.kind = Kind::starts_below, .threshold = 0.8}};
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
  following.own = {.kind = Kind::follows, .from = 1, .to = 0.5};
  const Cortex follower(tissue, CellSet(3, true), following);
  motion = at_rest(tissue);
  motion.internal = {0, 0.25, 1};
  motion.end_time_s = 10;
  EXPECT_EQ(follower.tensions(motion.step()), (std::vector<double>{0, 0.5, 2}));
}

// Contraction that is shut off early lets the furrow go, later it goes on, if walls and floor wait for their own cell.
TEST(OwnState, DecidesWhatTheClockDoesNot) {
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
TEST(OwnState, ARunGoesOnToTheSameBits) {
  const Scenario scenario =
      load_scenario(find_scenario("furrow-slice"),
                    {"cortex.shortening.program.time_min=[0, 11]", "time.end_min=17.8",
                     "cortex.shortening.trigger.measure=apical_area_ratio", "cortex.shortening.trigger.below=0.3",
                     "cortex.surface.tension_mN_per_m=0.01", "cortex.surface.follow.measure=height_ratio",
                     "cortex.surface.follow.from=1", "cortex.surface.follow.to=1.5"});
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
}  // namespace plica
