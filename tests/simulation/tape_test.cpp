// Gradients of whole runs agree with central differences over the same steps.
#include "simulation/tape.hpp"

#include "core/threads.hpp"
#include "support/tape_checks.hpp"

namespace {

const std::vector<TapeKey> keys_of_drosophila = {{"elasticity.young_modulus_Pa", 1000},
                                                 {"dynamics.surface_drag_Pa_s_per_um", 131},
                                                 {"contraction.apical.stiffness_nN_per_um", 4.82},
                                                 {"contraction.apical.preload_nN", 60}};

TEST(Tape, GradientsOfABlockAgreeWithDifferences) {
  expect_gradient({pulled_block(),
                   {"contraction.all.damping_nN_s_per_um=2"},
                   {{"contraction.all.stiffness_nN_per_um", 1}, {"contraction.all.damping_nN_s_per_um", 2}},
                   "contraction.all",
                   3});
}

TEST(Tape, GradientsOfAnEmbryoInItsShellAgreeWithDifferences) {
  expect_gradient({find_scenario("drosophila"),
                   {"time.integrator=\"bdf2\"", "vitelline.gap_um=0.5"},
                   keys_of_drosophila,
                   "contraction.apical",
                   60});
}

TEST(Tape, GradientsOfBackwardEulerAgreeWithDifferences) {
  expect_gradient({find_scenario("drosophila"),
                   {"time.integrator=\"backward-euler\"", "time.step_s=15", "vitelline.enabled=false"},
                   keys_of_drosophila,
                   "contraction.apical",
                   60,
                   {30}});
}

const std::vector<TapeKey> keys_of_slice = {{"cortex.apical.tension_mN_per_m", 1.4},
                                            {"cortex.apical.saturation_ratio", 0.16},
                                            {"cortex.floor.stiffness_mN_per_m", 0.7},
                                            {"cortex.walls.compression_ratio", 0.1},
                                            {"cortex.walls.relaxation_min", 6},
                                            {"cortex.surface.crowding_mN_per_m", 0.01},
                                            {"enclosed.yolk.bulk_modulus_Pa", 50000},
                                            {"elasticity.young_modulus_Pa", 5},
                                            {"elasticity.corner_barrier_Pa", 10},
                                            {"dynamics.surface_drag_Pa_s_per_um", 38},
                                            {"vitelline.gap_um", 0.5}};

// With compliant yolk, flowing cortices, a shell that nodes touch, and pairs that may touch.
TEST(Tape, GradientsOfAFurrowBeforeContactAgreeWithDifferences) {
  expect_gradient(
      {find_scenario("furrow-slice"), {"embryo.mirror=[\"y\"]"}, keys_of_slice, "cortex.apical", 240, {}, 1e-6});
}

// Through closure, where the slope changes its sign. Between the noise of steps that rounding ends early and the
// outcome's curvature, differences are no better than 1e-5.
// Both ways differentiate pairs by differences over 1e-5 um, along other directions, and closure amplifies their
// rounding.
TEST(Tape, GradientsOfAFurrowInContactAgreeWithDifferences) {
  expect_gradient({find_scenario("furrow-slice"),
                   {"time.tolerance_um=0.005", "embryo.mirror=[\"y\"]"},
                   {{"cortex.apical.tension_mN_per_m", 1.4}},
                   "",
                   1200,
                   {960},  // just after closure; later, slopes of this outcome are small
                   3e-5,
                   1e-4,
                   1e-7});
}

TEST(Tape, GradientsOfViscousElementsAgreeWithDifferences) {
  for (const char* model : {"corotational", "shape-memory"})
    for (const char* integrator : {"backward-euler", "bdf2"})
      expect_gradient({pulled_block(),
                       {"dynamics.shear_viscosity_Pa_s=1000", fmt::format("elasticity.model=\"{}\"", model),
                        fmt::format("time.integrator=\"{}\"", integrator)},
                       {{"dynamics.shear_viscosity_Pa_s", 1000}, {"contraction.all.stiffness_nN_per_um", 1}},
                       "contraction.all",
                       3});
}

TEST(Tape, GradientsOfFlowingInteriorsAgreeWithDifferences) {
  for (const char* integrator : {"backward-euler", "bdf2"})
    expect_gradient({pulled_block(),
                     {"elasticity={model=\"neo-hookean\",young_modulus_Pa=500,poisson_ratio=0.3,relaxation_min=0.05}",
                      fmt::format("time.integrator=\"{}\"", integrator)},
                     {{"elasticity.relaxation_min", 0.05}, {"elasticity.young_modulus_Pa", 500}},
                     "contraction.all",
                     4,
                     {},
                     1e-6});
}

// Cells start one after another; a cell that starts later has a weaker cortex at the end.
TEST(Tape, GradientsThroughTriggersAgreeWithDifferences) {
  const ScenarioSource block = pulled_block(R"([cortex.apical]
region = "all"
tension_mN_per_m = 3
stiffness_mN_per_m = 2
program = { time_min = [0, 0.05], activity = [0, 1] }
stiffness_program = { time_min = [0, 0.05], activity = [1, 0.1] }
trigger = { measure = "apical_area_ratio", below = 0.985 }
)");
  for (const char* integrator : {"backward-euler", "bdf2"})
    expect_gradient({block,
                     {fmt::format("time.integrator=\"{}\"", integrator)},
                     {{"cortex.apical.trigger.below", 0.985},
                      {"cortex.apical.tension_mN_per_m", 3},
                      {"contraction.all.stiffness_nN_per_um", 1}},
                     "contraction.all",
                     4,
                     {},
                     1e-6,
                     1e-4});
}

TEST(Tape, GradientsOfCellsThatFollowShapesAgreeWithDifferences) {
  for (const char* of : {"cell", "neighbours"})
    expect_gradient({pulled_block(R"([cortex.walls]
region = "all"
faces = "lateral"
tension_mN_per_m = 3
follow = { measure = "apical_stretch", from = 0.99, to = 0.7 }
)"),
                     {fmt::format("cortex.walls.follow.of={}", of)},
                     {{"cortex.walls.follow.from", 0.99}, {"cortex.walls.tension_mN_per_m", 3}},
                     "cortex.walls",
                     4,
                     {},
                     1e-6});
}

TEST(Tape, GradientsOfACableAgreeWithDifferences) {
  expect_gradient({pulled_block(R"([region.part]
x_um = [0, 100]
[contraction.cable]
region = "part"
border = "all"
preload_nN = 20
)"),
                   {},
                   {{"contraction.cable.preload_nN", 20}},
                   "contraction.cable",
                   4,
                   {},
                   1e-6});
}

TEST(Tape, GradientsOfGrowthOnAFoundationAgreeWithDifferences) {
  expect_gradient({pulled_block(R"([growth.all]
region = "all"
rate_per_h = 100
in_plane = 0.9
[foundation.base]
region = "all"
stiffness_nN_per_um3 = 0.02
drag_Pa_s_per_um = 100
[cortex.apical]
region = "all"
tension_mN_per_m = 2
stiffness_mN_per_m = 2
saturation_ratio = 0.2
)"),
                   {},
                   {{"growth.all.rate_per_h", 100},
                    {"growth.all.in_plane", 0.9},
                    {"foundation.base.stiffness_nN_per_um3", 0.02},
                    {"foundation.base.drag_Pa_s_per_um", 100}},
                   "cortex.apical",
                   4});
}

// Factors on the stiffness of cells, in both laws, with relaxation, viscosity and growth.
TEST(Tape, GradientsByStiffnessOfCellsAgreeWithDifferences) {
  const std::string growing = "growth.all={region=\"all\",rate_per_h=100}";
  for (const std::vector<std::string>& overrides : std::vector<std::vector<std::string>>{
           {"elasticity={model=\"corotational\",young_modulus_Pa=500}", "dynamics.shear_viscosity_Pa_s=1000"},
           {"elasticity={model=\"neo-hookean\",young_modulus_Pa=500,relaxation_min=0.05}", growing},
           {"elasticity={model=\"corotational\",young_modulus_Pa=500}", growing, "embryo.elements_per_cell=[1,1,2]"}})
    expect_gradient({pulled_block(), overrides, {{"elasticity.young_modulus_Pa", 500}}, "elasticity", 3});
}

// Growth of cells: target volumes, rest shapes, and rest areas and memory of walls of two cells.
TEST(Tape, GradientsByGrowthOfCellsAgreeWithDifferences) {
  const ScenarioSource growing = pulled_block(R"([growth.all]
region = "all"
rate_per_h = 100
in_plane = 0.9
[cortex.walls]
region = "all"
faces = "lateral"
tension_mN_per_m = 2
stiffness_mN_per_m = 2
)");
  for (const char* change :
       {"embryo.elements_per_cell=[1,1,2]", "embryo.mirror=[\"y\"]", "cortex.walls.relaxation_min=0.05"})
    expect_gradient({growing, {change}, {{"growth.all.rate_per_h", 100}}, "growth.all", 4});
}

// Before the first exchange: walls by their direction, with noise; interiors that flow.
TEST(Tape, GradientsOfPolarTensionsAgreeWithDifferences) {
  expect_gradient({find_scenario("convergent-extension"),
                   {"embryo.length_um=16", "embryo.width_um=16", "embryo.cell_count=12"},
                   {{"cortex.lateral.direction.strongest", 1.6},
                    {"cortex.lateral.noise.spread", 0.5},
                    {"elasticity.relaxation_min", 1}},
                   "cortex.lateral",
                   40});
}

TEST(Tape, GradientsThroughSignalsAgreeWithDifferences) {
  for (const char* of : {"cell", "neighbours"})
    expect_gradient({find_scenario("wave"),
                     {fmt::format("cortex.apical.follow.of={}", of), "embryo.length_um=60", "embryo.width_um=20",
                      "embryo.cell_count=60", "signal.u.source={region=\"left-end\",per_min=0.1}",
                      "cortex.apical.program={time_min=[0,0.2],activity=[0,1]}"},
                     {{"signal.u.diffusion_um2_per_min", 10},
                      {"signal.u.constants.k", 5},
                      {"signal.u.initial", 1},
                      {"cortex.apical.follow.to", 0.8},
                      {"cortex.apical.tension_mN_per_m", 8}},
                     "cortex.apical",
                     20});
}

// The furrow of the embryo of the experiments, whose floors soften as their apices have shrunk.
TEST(Tape, GradientsOfAFurrowWithTriggersAgreeWithDifferences) {
  expect_gradient({find_scenario("furrow-slice"),
                   {"embryo.mirror=[\"y\"]", "cortex.floor.trigger={measure=\"apical_area_ratio\",below=0.5263}",
                    "cortex.floor.stiffness_program={time_min=[0,4],activity=[1,0.14]}"},
                   {{"cortex.floor.trigger.below", 0.5263}, {"cortex.apical.tension_mN_per_m", 1.4}},
                   "",
                   660,
                   {},
                   1e-5,
                   1e-4,
                   1e-7});  // crossings, by differences in one of both ways
}

// Polygons, whose walls have nodes that hang on edges, and rest areas of walls that flow.
TEST(Tape, GradientsOfPolygonsAgreeWithDifferences) {
  expect_gradient({{"egg", "egg.toml", egg + R"(
[elasticity]
model = "neo-hookean"
young_modulus_Pa = 100
[vitelline]
drag_Pa_s_per_um = 50
gap_um = 0.05
[enclosed.yolk]
[region.belly]
angle_deg = [-40, 40]
[cortex.apical]
region = "belly"
tension_mN_per_m = 1
[cortex.walls]
region = "all"
faces = "lateral"
stiffness_mN_per_m = 0.1
relaxation_min = 1
[time]
end_s = 15
[stop]
at_equilibrium = false
)"},
                   {},
                   {{"cortex.apical.tension_mN_per_m", 1},
                    {"vitelline.drag_Pa_s_per_um", 50},
                    {"elasticity.young_modulus_Pa", 100}},
                   "cortex.walls",
                   15});
}

// Daughters that grow; an outcome before the cut, too.
TEST(Tape, GradientsThroughDivisionAgreeWithDifferences) {
  for (const char* integrator : {"backward-euler", "bdf2"})
    expect_gradient({pulled_block(R"([cortex.apical]
region = "all"
tension_mN_per_m = 3
stiffness_mN_per_m = 2
relaxation_min = 0.1
[division.first]
region = "all"
at_s = 1
growth_min = 0.04
[division.second]
region = "all"
at_s = 2
plane = "transverse"
)"),
                     {fmt::format("time.integrator=\"{}\"", integrator)},
                     {{"contraction.all.stiffness_nN_per_um", 1},
                      {"cortex.apical.relaxation_min", 0.1},
                      {"elasticity.young_modulus_Pa", 1000}},
                     "cortex.apical",
                     3,
                     {0.5}},
                    2);
}

TEST(Tape, GradientsThroughDivisionAndTriggersAgreeWithDifferences) {
  expect_gradient({pulled_block(R"([cortex.apical]
region = "all"
tension_mN_per_m = 3
program = { time_min = [0, 0.05], activity = [0, 1] }
trigger = { measure = "apical_area_ratio", below = 0.985 }
[division.all]
region = "all"
at_s = 2
)"),
                   {},
                   {{"cortex.apical.trigger.below", 0.985}, {"cortex.apical.tension_mN_per_m", 3}},
                   "contraction.all",
                   4,
                   {},
                   1e-6,
                   1e-4},
                  1);
}

// Rest shapes and rest areas after an exchange follow from positions and flowed interiors before.
TEST(Tape, GradientsThroughGrowthAndExchangeAgreeWithDifferences) {
  expect_gradient(
      {find_scenario("convergent-extension"),
       {"embryo.length_um=20", "embryo.width_um=20", "embryo.cell_count=20", "exchange.below_um=1.5",
        "exchange.new_length_um=1.6", "growth.all={region=\"all\",rate_per_h=2,in_plane=1}",
        "cortex.lateral.relaxation_min=2", "cortex.lateral.stiffness_mN_per_m=0.1"},
       {{"cortex.lateral.direction.strongest", 1.6}, {"growth.all.rate_per_h", 2}, {"elasticity.relaxation_min", 1}},
       "cortex.lateral",
       90},
      2);
}

// Cells that have to leave turn their walls, whose new length follows from the old one, and leave.
TEST(Tape, GradientsThroughExtrusionAgreeWithDifferences) {
  expect_gradient({{"leaving", "leaving.toml", sheet_that_cells_leave("3.5")},
                   {},
                   {{"cortex.lateral.tension_mN_per_m", 0.1}, {"elasticity.young_modulus_Pa", 100}},
                   "",
                   210,
                   {},
                   1e-6},
                  3);
}

TEST(Tape, RefusesWhatHasNoDerivativesByName) {
  const auto refused = [](const std::vector<std::string>& overrides) {
    try {
      const ScenarioSource block = pulled_block();
      (void)Tape(load_scenario(block, overrides), {.until_s = 2});
    } catch (const NoGradient& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(refused({}), "");
  EXPECT_EQ(refused({"dynamics.density_kg_per_m3=1000", "time.integrator=\"backward-euler\""}),
            "inertia: this law has no derivatives yet; remove it from the scenario");
  EXPECT_EQ(refused({"cortex.top={region=\"all\",tension_mN_per_m=1}",
                     "cortex.top.trigger={measure=\"height_ratio\",above=2}"}),
            "cortex.top: a jump at a time given by a trigger has no derivative; let its program rise from activity 0, "
            "or start at a given time");
  const Scenario scenario = load_scenario(pulled_block());
  const Tape tape(scenario, {.until_s = 1});
  EXPECT_THROW(
      (void)tape.parameter("embryo.length_um", load_scenario(pulled_block(), {"embryo.length_um=61"}), scenario, 1),
      NoGradient);
  EXPECT_THROW((void)tape.gradient({{1, Vectors(tape.tissue().node_count(), Vec3::Zero())}}, {.law = "drag"}),
               UsageError);
  EXPECT_THROW((void)tape.state_at(0.7), UsageError);

  const std::vector<std::string> divides = {"division.all={region=\"all\",at_s=0.5}", "time.end_s=1"};
  const Scenario of_daughters = load_scenario(pulled_block("[monitor.area]\nquantity = \"area_ratio\"\n"), divides);
  const Tape later(of_daughters, {});
  EXPECT_EQ(later.tissue(later.steps()).cells.size(), 12u);
  EXPECT_THROW((void)later.outcome("area.area_ratio", later.steps()), NoGradient);
  EXPECT_THROW((void)later.parameter("division.all.volume_ratio", of_daughters, of_daughters, 1), NoGradient);
}

TEST(Tape, IsBitwiseTheRunForAnyThreads) {
  const Scenario scenario = load_scenario(find_scenario("drosophila"), {"time.end_s=20"});
  const auto gradient_with = [&](int threads) {
    const ThreadCount count(threads);
    const Tape tape(scenario, {});
    Simulation simulation(scenario);
    simulation.run();
    EXPECT_EQ(tape.positions(tape.steps()), simulation.state().positions);
    const OutcomeGradient outcome = {{tape.steps(), Random(3).vectors(tape.tissue().node_count())}};
    return tape.gradient(outcome, {.law = "contraction.apical"})->by_strength;
  };
  EXPECT_EQ(gradient_with(1), gradient_with(3));
}

}  // namespace
