// Time left of a run, from curves of work and from steps that are given: no clock is read.
#include "record/time_left.hpp"

#include <cmath>
#include <fstream>

#include "scenario/builtin.hpp"
#include "scenario/load.hpp"
#include "support/own_folder.hpp"

namespace {

constexpr const char* table = "fold,100,1,2,4,30\nfold-deep,7,3\n";

RunControls to_the_end(double end_s) {
  RunControls controls;
  controls.end_s = end_s;
  controls.stop_at_equilibrium = false;
  return controls;
}

TEST(TimeLeft, ACurveIsARowOfTheTable) {
  const auto curve = curve_in(table, "fold");
  ASSERT_TRUE(curve);
  EXPECT_DOUBLE_EQ(curve->at(0), 0);
  EXPECT_DOUBLE_EQ(curve->at(1.5), 37.5);
  EXPECT_DOUBLE_EQ(curve->at(30), 100);
  EXPECT_NEAR(curve->at(56), 125, 1e-9);  // as fast as from 4 to 30 s
  EXPECT_EQ(curve_in(table, "fold-deep")->times_s.size(), 2U);
  EXPECT_FALSE(curve_in(table, "fo"));
  EXPECT_FALSE(curve_in(table, ""));
}

TEST(TimeLeft, FollowsTheCurveAtTheSpeedOfThisMachine) {
  TimeLeft left(to_the_end(30), curve_in(table, "fold"));
  EXPECT_FALSE(left.seconds());
  EXPECT_EQ(left.text(), "");
  left.add(45, 1, 3);  // a quarter of the work
  EXPECT_DOUBLE_EQ(*left.seconds(), 135);
  EXPECT_EQ(left.text(), "about 2 min left");
  left.add(300, 4, 3);  // the machine has become slower
  EXPECT_DOUBLE_EQ(*left.seconds(), 100);
}

TEST(TimeLeft, ResumesAndEndsElsewhereThanTheCurve) {
  TimeLeft resumed(to_the_end(30), curve_in(table, "fold"), 2);
  resumed.add(10, 4, 3);  // from a half to three quarters
  EXPECT_DOUBLE_EQ(*resumed.seconds(), 10);
  TimeLeft shorter(to_the_end(2), curve_in(table, "fold"));
  shorter.add(10, 1, 3);
  EXPECT_DOUBLE_EQ(*shorter.seconds(), 10);
  TimeLeft longer(to_the_end(56), curve_in(table, "fold"));
  longer.add(50, 1, 3);
  EXPECT_NEAR(*longer.seconds(), 200, 1e-9);
  // The curve ended at equilibrium, so this run does, too.
  RunControls at_rest = to_the_end(3600);
  at_rest.stop_at_equilibrium = true;
  TimeLeft resting(at_rest, curve_in(table, "fold"));
  resting.add(50, 1, 3);
  EXPECT_DOUBLE_EQ(*resting.seconds(), 150);
}

TEST(TimeLeft, WithoutACurveStepsLengthenInProportionToTime) {
  RunControls controls = to_the_end(1000);
  controls.max_step_s = 10;
  controls.frame_every_s = 0;
  TimeLeft left(controls, {});
  double time_s = 1, elapsed_s = 0;
  const auto step = [&] {
    time_s = std::min(1000.0, time_s + std::min(0.1 * time_s, 10.0));
    left.add(++elapsed_s, time_s, 3);
  };
  for (int i = 0; i < 5; ++i) {
    EXPECT_FALSE(left.seconds());
    step();
  }
  for (int i = 0; i < 15; ++i) step();
  const double estimate = *left.seconds(), then_s = elapsed_s;
  while (time_s < 1000) step();
  EXPECT_NEAR(estimate, elapsed_s - then_s, 0.1 * (elapsed_s - then_s));
  EXPECT_NEAR(*left.seconds(), 0, 1e-9);
}

TEST(TimeLeft, TowardsEquilibriumSpeedsDecay) {
  RunControls controls = to_the_end(1e6);
  controls.stop_at_equilibrium = true;
  controls.equilibrium_speed_um_per_s = std::exp(-10);
  TimeLeft left(controls, {});
  for (int i = 1; i <= 20; ++i) left.add(i, 15 * i, std::exp(-0.1 * i));
  EXPECT_NEAR(*left.seconds(), 80, 1e-9);
  // Not before the last change of activity.
  controls.program_points_s = {500};
  TimeLeft rising(controls, {});
  for (int i = 1; i <= 20; ++i) rising.add(i, 15 * i, std::exp(-0.1 * i));
  EXPECT_GT(*rising.seconds(), 1000);
}

TEST(TimeLeft, AModifiedScenarioHasTheCurveOfItsBase) {
  const Scenario fold = load_scenario(find_scenario("drosophila"), {"elasticity.young_modulus_Pa=500.0"});
  EXPECT_EQ(fold.builtin, "drosophila");
  EXPECT_TRUE(builtin_curve(fold));
  const Scenario derived = load_scenario({"mine", "mine.toml", "format = 1\nbase = \"wing-disc\"\n"});
  EXPECT_EQ(derived.builtin, "wing-disc");
  EXPECT_TRUE(builtin_curve(derived));
  EXPECT_FALSE(builtin_curve(Scenario()));
}

TEST(TimeLeft, CurvesOfBuiltInScenariosEndWithThem) {
  std::size_t curves = 0;
  for (const BuiltinScenario& builtin : builtin_scenarios()) {
    const Scenario scenario = load_scenario(find_scenario(std::string(builtin.name)));
    const auto curve = builtin_curve(scenario);
    if (!curve) continue;
    ++curves;
    EXPECT_TRUE(std::ranges::is_sorted(curve->times_s)) << builtin.name;
    EXPECT_LE(curve->times_s.back(), scenario.time.end_s) << builtin.name;
    if (scenario.stop.at_equilibrium) continue;
    EXPECT_DOUBLE_EQ(curve->times_s.back(), scenario.time.end_s) << builtin.name;
  }
  EXPECT_GE(curves, 9U);
}

TEST(TimeLeft, ExpectedWorkIsKnownByACurveAndElseBounded) {
  const auto [least, most] = expected_work(to_the_end(2), curve_in(table, "fold"));
  EXPECT_DOUBLE_EQ(least, 50);
  EXPECT_DOUBLE_EQ(most, 50);
  RunControls fixed = to_the_end(100);
  fixed.fixed_step_s = 1;
  EXPECT_DOUBLE_EQ(expected_work(fixed, {}).first, 400);
  const auto [least_adaptive, most_adaptive] = expected_work(to_the_end(3600), {});
  EXPECT_LT(least_adaptive, most_adaptive);
  EXPECT_GT(least_adaptive, 4 * 3500 / 15.0);  // nearly all steps as long as the snapshots are apart
}

class TimeLeftOfRuns : public OwnFolder {};

TEST_F(TimeLeftOfRuns, AnEarlierRunOfThisNameIsACurve) {
  Scenario scenario;
  scenario.name = "fold";
  EXPECT_FALSE(curve_of_run(folder, scenario));
  std::ofstream(folder / "summary.json") << R"({"scenario": "fold", "status": "end_time"})";
  std::ofstream(folder / "series.csv") << "time_s,newton_iterations,linear_iterations\n0,,\n1,2,10\n4,3,\n";
  const auto curve = curve_of_run(folder, scenario);
  ASSERT_TRUE(curve);
  EXPECT_DOUBLE_EQ(curve->at(1), 4);
  EXPECT_DOUBLE_EQ(curve->at(4), 8);
  scenario.name = "another";
  EXPECT_FALSE(curve_of_run(folder, scenario));
  std::ofstream(folder / "summary.json") << "{";
  EXPECT_FALSE(curve_of_run(folder, scenario));
}

}  // namespace
