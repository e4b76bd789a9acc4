#include "simulation/simulation.hpp"

#include <thread>

#include "scenario/load.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"
#include "support/ran.hpp"

namespace {

TEST(Simulation, GoesToEquilibriumWhereForcesBalanceWithoutDrag) {
  RunControls controls{.end_s = 1e5, .equilibrium_speed_um_per_s = 1e-5};
  const Simulation result = ran(dimpling_sheet(), controls);
  ASSERT_EQ(result.status(), RunStatus::equilibrium) << result.failure();
  ASSERT_TRUE(result.equilibrium_time_s().has_value());
  EXPECT_EQ(*result.equilibrium_time_s(), result.state().time_s);
  // A step that stands still has no drag: what is left is d A v, up to 0.14 * 400 * 1e-5 nN a node, times two sides.
  State still = result.state();
  still.time_s += 1;
  EXPECT_LE(largest(unbalanced_forces(result.model(), result.state(), still)), 2e-4);
  // And the middle cell has contracted its apex.
  const Model& model = result.model();
  const auto& corners = model.tissue.cells[4].corners;
  const auto length = [&](const Vectors& x) { return (x[corners[5].index()] - x[corners[4].index()]).norm(); };
  EXPECT_LT(length(result.state().positions), 0.9 * length(model.tissue.rest_positions));
}

TEST(Simulation, RestDoesNotDependOnTheStep) {
  std::vector<State> ends;
  for (const TimeOrder order : {TimeOrder::first, TimeOrder::second})
    for (const double step : {2.0, 5.0, 20.0, 0.0}) {
      RunControls controls{.scheme = {.order = order}};
      if (step > 0) controls.fixed_step_s = step;
      controls.equilibrium_speed_um_per_s = 1e-7;
      controls.end_s = 1e5;
      const Simulation result = ran(dimpling_sheet(), controls);
      ASSERT_EQ(result.status(), RunStatus::equilibrium) << result.failure();
      ends.push_back(result.state());
    }
  double worst = 0;
  for (const State& end : ends) worst = std::max(worst, largest_distance(end.positions, ends[0].positions));
  std::printf(
      "block at rest: positions differ by %.1e um between steps of 2, 5, 20 s and adaptive ones, of both orders\n",
      worst);
  EXPECT_LE(worst, 1e-3);
}

TEST(Simulation, AdaptiveStepsLandOnEveryFrame) {
  Model model = dimpling_sheet();
  RunControls controls{.end_s = 60, .stop_at_equilibrium = false, .frame_every_s = 7};
  int frames = 0;
  const Simulation result = ran(std::move(model), controls, [&](const AcceptedStep& step, const Model&) {
    if (step.frame_is_due) {
      ++frames;
      EXPECT_NEAR(step.state.time_s, 7 * frames, 1e-9);
    }
    EXPECT_NEAR(step.state.time_s - step.previous.time_s, step.duration_s, 1e-9);
  });
  EXPECT_EQ(result.status(), RunStatus::end_time);
  EXPECT_NEAR(result.state().time_s, 60, 1e-9);
  EXPECT_EQ(frames, 8);
}

TEST(Simulation, AdaptiveStepsLandOnTheProgramsPoints) {
  Model model = dimpling_sheet();
  RunControls controls{.end_s = 60, .stop_at_equilibrium = false, .program_points_s = {0, 3.3, 41.7}};
  int met = 0;
  ran(std::move(model), controls, [&](const AcceptedStep& step, const Model&) {
    for (const double point : controls.program_points_s) {
      met += std::abs(step.state.time_s - point) < 1e-9;
      EXPECT_FALSE(step.previous.time_s < point - 1e-9 && step.state.time_s > point + 1e-9) << "steps over " << point;
    }
  });
  EXPECT_EQ(met, 2);
}

TEST(Simulation, FixedStepsFormAGridWhateverTheFrames) {
  Model model = dimpling_sheet();
  RunControls controls{.fixed_step_s = 0.7, .end_s = 10, .stop_at_equilibrium = false, .frame_every_s = 2};
  int steps = 0, frames = 0;
  const Simulation result = ran(std::move(model), controls, [&](const AcceptedStep& step, const Model&) {
    ++steps;
    frames += step.frame_is_due;
    EXPECT_NEAR(step.state.time_s, std::min(0.7 * steps, 10.0), 1e-9);
  });
  EXPECT_EQ(steps, 15);  // fourteen of 0.7 and one of 0.2
  EXPECT_EQ(result.steps(), steps);
  EXPECT_EQ(frames, 5);  // the first step at or past 2, 4, 6, 8, 10
}

TEST(Simulation, EquilibriumCountsOnlyAfterTheProgram) {
  Model model(build_block({.length_um = 60, .width_um = 60, .cell_height_um = 40, .cells = {3, 3, 1}}));
  add_elasticity(model);
  add_contraction(model, CellSet(9, true), {.stiffness = 1}, Program({0, 100, 101}, {0, 0, 1}));
  add_drag(model);
  RunControls controls{.end_s = 5000, .program_points_s = {0, 100, 101}};
  const Simulation result = ran(std::move(model), controls);
  ASSERT_EQ(result.status(), RunStatus::equilibrium) << result.failure();
  EXPECT_GE(*result.equilibrium_time_s(), 101);
  // What the contraction did was not stepped over.
  EXPECT_GT(result.steps(), 5);
}

// A wave without a program: slow at its start, when few cells pull, and not at rest before the last one does.
TEST(Simulation, EquilibriumCountsOnlyAfterTheWave) {
  Model model(build_block({.length_um = 60, .width_um = 60, .cell_height_um = 40, .cells = {3, 3, 1}}));
  add_elasticity(model);
  PatternRule wave;
  wave.delay = {PatternAxis::along, StartDelay::From::low, 0.1};
  const CellPattern pattern = cell_pattern(model.tissue, CellSet(9, true), wave);
  auto law =
      std::make_unique<Contraction>(contraction_springs(model.tissue, pattern, {.stiffness = 1}), Program(), pattern);
  RunControls controls{.program_points_s = law->program_points_s()};
  EXPECT_EQ(controls.program_points_s.size(), 3u);
  model.laws.push_back(std::move(law));
  add_drag(model, 0.01);
  controls.max_step_s = 500;
  controls.end_s = 5000;
  controls.frame_every_s = 0;
  int met = 0;
  const Simulation result = ran(std::move(model), controls, [&](const AcceptedStep& step, const Model&) {
    for (const double arrival : {200.0, 400.0}) {
      EXPECT_FALSE(step.previous.time_s < arrival - 1e-9 && step.state.time_s > arrival + 1e-9) << arrival;
      met += std::abs(step.state.time_s - arrival) < 1e-9;
    }
  });
  EXPECT_EQ(met, 2);
  ASSERT_EQ(result.status(), RunStatus::equilibrium) << result.failure();
  EXPECT_GT(*result.equilibrium_time_s(), 400);
}

TEST(Simulation, GoesOnToTheEndWhenAskedAndNotesTheTimeOfEquilibrium) {
  Model model = dimpling_sheet();
  RunControls controls{.end_s = 300, .equilibrium_speed_um_per_s = 0.05, .stop_at_equilibrium = false};
  const Simulation result = ran(std::move(model), controls);
  EXPECT_EQ(result.status(), RunStatus::end_time);
  ASSERT_TRUE(result.equilibrium_time_s().has_value());
  EXPECT_LT(*result.equilibrium_time_s(), 300);
}

TEST(Simulation, StopsWhenAskedAndGoesOnWhenAskedAgain) {
  RunControls controls{.end_s = 30};
  Simulation simulation({std::make_unique<Model>(dimpling_sheet()), controls});
  simulation.stop_when([&] { return simulation.steps() >= 3; });
  EXPECT_EQ(simulation.run(), RunStatus::under_way);
  EXPECT_EQ(simulation.steps(), 3);
  simulation.stop_when({});
  EXPECT_EQ(simulation.run(), RunStatus::end_time);
  EXPECT_EQ(simulation.state().positions, ran(dimpling_sheet(), controls).state().positions);
}

TEST(Simulation, ACriterionEndsItAsPlannedAndAtRestAsEquilibrium) {
  MeasurePlan soon;
  Monitor& clock = soon.monitors.emplace_back();
  clock.name = "clock";
  clock.quantity = quantity_named("time");
  soon.stop.criteria.push_back({.name = "late", .monitor = 0, .above = 0.1, .below = {}});
  const Simulation early = ran(dimpling_sheet(), RunControls{}, {}, soon);
  EXPECT_EQ(early.status(), RunStatus::end_time);
  EXPECT_TRUE(early.criterion_met());
  EXPECT_GT(early.time_s(), 0.1);
  EXPECT_LT(early.time_s(), 1);

  RunControls controls{.end_s = 1e5, .equilibrium_speed_um_per_s = 1e-3, .stop_at_equilibrium = false};
  MeasurePlan at_rest = soon;
  at_rest.stop.all = at_rest.stop.needs_rest = true;
  const Simulation late = ran(dimpling_sheet(), controls, {}, at_rest);
  EXPECT_EQ(late.status(), RunStatus::equilibrium);
  EXPECT_TRUE(late.criterion_met());
  EXPECT_EQ(late.equilibrium_time_s().value(), late.time_s());
  EXPECT_FALSE(ran(dimpling_sheet(), controls).criterion_met());
}

TEST(Simulation, GivesUpWithTheLastGoodStateAndAReason) {
  Model model = dimpling_sheet();
  Vectors loads(model.tissue.node_count(), Vec3::Zero());
  loads[0].x() = std::numeric_limits<double>::quiet_NaN();
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  const Simulation result = ran(std::move(model), RunControls{});
  EXPECT_EQ(result.status(), RunStatus::failed);
  EXPECT_FALSE(result.failure().empty());
  EXPECT_EQ(result.state().positions, result.model().tissue.rest_positions);
}

TEST(Simulation, ACopyIsAForkInTime) {
  const Scenario scenario = load_scenario(find_scenario("drosophila"), {"time.end_s=6"});
  Simulation whole(scenario), first(scenario);
  whole.run();
  for (int step = 0; step < 5 || !first.is_resumable(); ++step) ASSERT_TRUE(first.step());
  const int steps = first.steps();
  Simulation fork = first, moved = std::move(first);
  EXPECT_EQ(fork.steps(), steps);
  EXPECT_EQ(fork.measures()["furrow_depth_um"], moved.measures()["furrow_depth_um"]);
  // In turns: neither disturbs the other.
  while (fork.status() == RunStatus::under_way || moved.status() == RunStatus::under_way) {
    (void)moved.step();
    (void)fork.step();
  }
  for (const Simulation* end : {&fork, &moved}) {
    EXPECT_EQ(end->status(), RunStatus::end_time);
    EXPECT_EQ(end->steps(), whole.steps());
    EXPECT_EQ(end->state().positions, whole.state().positions);
    EXPECT_EQ(end->measures()["vml_speed_um_per_s"], whole.measures()["vml_speed_um_per_s"]);
  }
}

// In two threads, with every linear solver: MUMPS and METIS keep things to themselves.
TEST(Simulation, TwoAtOnceDoNotDisturbEachOther) {
  const auto end_of = [](const std::string& method, const std::string& scenario) {
    Simulation simulation(
        load_scenario(find_scenario(scenario), {"time.end_s=2", "time.linear_solver=\"" + method + "\""}));
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
    return simulation.state().positions;
  };
  for (const std::string method : {"direct", "cholesky", "multigrid"}) {
    const Vectors alone = end_of(method, "drosophila"), other_alone = end_of(method, "xenopus");
    Vectors together, other_together;
    std::thread other([&] { other_together = end_of(method, "xenopus"); });
    together = end_of(method, "drosophila");
    other.join();
    EXPECT_TRUE(together == alone) << method;
    EXPECT_TRUE(other_together == other_alone) << method;
  }
}

TEST(Simulation, RunsUntilATimeOnWhichAStepEnds) {
  Simulation simulation(load_scenario(find_scenario("drosophila"), {"time.end_s=20"}));
  EXPECT_EQ(simulation.run_until(3.21), RunStatus::under_way);
  EXPECT_NEAR(simulation.time_s(), 3.21, 1e-12);
  EXPECT_EQ(simulation.run_until(3.21), RunStatus::under_way) << "nothing to do";
  EXPECT_NEAR(simulation.time_s(), 3.21, 1e-12);
  EXPECT_EQ(simulation.run_until(1000), RunStatus::end_time);
  EXPECT_NEAR(simulation.time_s(), 20, 1e-12);
  EXPECT_FALSE(simulation.step());
}

// Drag is far stiffer than the tissue in a short step, and what rounding of positions makes of it is all that is left
// to solve.
TEST(Simulation, ShortStepsAndStrongDragAreSolved) {
  const std::vector<std::vector<std::string>> cases = {
      {"output.frame_every_min=0.333333333", "time.end_s=60"},
      {"time.first_step_s=1e-6", "time.end_s=1"},
      {"time.first_step_s=1e-6", "time.end_s=1", "time.integrator=bdf2"},
      {"time.step_s=1e-6", "time.end_s=2e-5"},
      {"time.step_s=1e-6", "time.end_s=2e-5", "time.linear_solver=multigrid"},
      {"time.step_s=1e-6", "time.end_s=2e-5", "time.linear_solver=direct"},
      {"dynamics.surface_drag_Pa_s_per_um=1e9", "time.end_s=60", "stop.at_equilibrium=false"},
      {"contraction.apical.program.time_min=[0, 0.16666667]", "contraction.apical.program.activity=[0, 1]",
       "output.frame_every_s=10", "time.end_s=20"}};
  int ran = 0;
  for (const auto& overrides : cases) {
    Simulation simulation(load_scenario(find_scenario("drosophila"), overrides));
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << overrides[0] << ": " << simulation.failure();
    ++ran;
  }
  EXPECT_EQ(ran, 8);
}

// Contraction that is switched off at 20 s: a step ends there, still under tension, and the next is a short one.
TEST(Simulation, TakesAJumpOnAStepsEnd) {
  for (const char* integrator : {"backward-euler", "bdf2"}) {
    Simulation simulation(load_scenario(
        find_scenario("drosophila"),
        std::vector<std::string>{"contraction.apical.program.time_s=[0, 20, 20]", "time.end_s=60",
                                 "contraction.apical.program.activity=[1, 1, 0]", "output.frame_every_s=0",
                                 std::string("time.integrator=") + integrator}));
    ASSERT_EQ(simulation.run_until(20), RunStatus::under_way) << simulation.failure();
    const double depth = *simulation.measures()["furrow_depth_um"],
                 area = *simulation.measures()["vml_apical_area_ratio"];
    EXPECT_GT(depth, 4);
    EXPECT_LT(area, 0.9);
    simulation.step();
    EXPECT_GT(*simulation.measures()["vml_apical_area_ratio"], area) << "apices open at once";
    EXPECT_NEAR(simulation.time_s(), 20 + simulation.controls().first_step_s, 1e-9);
    EXPECT_EQ(simulation.run(), RunStatus::end_time);
    EXPECT_LT(*simulation.measures()["furrow_depth_um"], 0.7 * depth) << integrator;
    EXPECT_GT(*simulation.measures()["vml_apical_area_ratio"], 0.95) << integrator;
  }
}

// At rest when the jump comes is not at rest for good.
TEST(Simulation, IsNotAtEquilibriumBeforeTheLastJump) {
  Simulation simulation(
      load_scenario(find_scenario("drosophila"),
                    std::vector<std::string>{"contraction.apical.program.time_min=[0, 40, 40]", "time.end_min=60",
                                             "contraction.apical.program.activity=[1, 1, 0]"}));
  EXPECT_EQ(simulation.run(), RunStatus::equilibrium) << simulation.failure();
  EXPECT_GT(simulation.time_s(), 41 * 60);
  EXPECT_LT(std::abs(*simulation.measures()["furrow_depth_um"]), 1);
}

}  // namespace
