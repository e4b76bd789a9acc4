// Growth of cells: tensors, free growth without stress, the stress of a held bar, and growth with division, mirror
// planes and resumed runs.
#include "mechanics/growth.hpp"

#include "mechanics/active/cortex.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "support/divided.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"

namespace {

TEST(ProgramIntegral, IsThatOfItsActivity) {
  const Program program({10, 20, 20, 40}, {1, 3, 0.5, 2});
  Random random(1);
  for (int k = 0; k < 20; ++k) {
    const double from = 25 + random.number(30), to = 25 + random.number(30);
    double sum = 0;
    constexpr int parts = 20000;
    for (int i = 0; i < parts; ++i) sum += program.at(from + (i + 0.5) / parts * (to - from)) * (to - from) / parts;
    EXPECT_NEAR(program.integral(from, to), sum, 5e-3);
    EXPECT_NEAR(program.integral(from, to), -program.integral(to, from), 1e-12);
  }
  EXPECT_EQ(Program().integral(3, 10), 7);
  EXPECT_EQ(program.integral(20, 30), (0.5 + 1.25) / 2 * 10);
}

TEST(CellGrowth, FactorsOfCellsScaleTheirRates) {
  const Tissue tissue = build_block(two_cells);
  const CellGrowth law(tissue, CellSet{true, true}, {0.01, {0.6, 0.3, 0.1}});
  std::vector<GrowthTensor> tensors;
  with_strengths(law, std::vector<double>{2, 0.5})->grow(law.first_internal(tissue), 20, tensors);
  EXPECT_NEAR(tensors.at(0).volume, std::exp(0.4), 1e-14);
  EXPECT_NEAR(tensors.at(1).volume, std::exp(0.1), 1e-14);
  EXPECT_NEAR(tensors[0].G.determinant(), tensors[0].volume, 1e-14);
}

TEST(CellGrowth, StretchesAlongTheAxesOfTheCellAndTablesMultiply) {
  const Tissue tissue = build_block(two_cells);
  const CellGrowth law(tissue, CellSet{true, true}, {0.01, {0.6, 0.3, 0.1}});
  std::vector<double> internal = law.first_internal(tissue);
  std::vector<GrowthTensor> tensors;
  law.grow(internal, 20, tensors);
  const double v = 0.01 * 20;
  const Mat3 one = Vec3(std::exp(0.6 * v), std::exp(0.3 * v), std::exp(0.1 * v)).asDiagonal();
  EXPECT_LE((tensors.at(1).G - one).norm(), 1e-14);
  EXPECT_NEAR(tensors[1].volume, std::exp(v), 1e-14);
  EXPECT_NEAR(tensors[1].area(Vec3::UnitZ()), std::exp(0.9 * v), 1e-14);
  const CellGrowth other(tissue, CellSet{true, false}, {-0.02, {0.5, 0, 0.5}, Program({0, 10, 10}, {0, 2, 0})});
  other.grow(internal, 20, tensors);
  const Mat3 shrunk = Vec3(std::exp(-v / 2), 1, std::exp(-v / 2)).asDiagonal();
  EXPECT_LE((tensors[0].G - one * shrunk).norm(), 1e-14);
  EXPECT_LE((tensors[1].G - one).norm(), 1e-14);
  EXPECT_TRUE(other.is_growing(internal, 9));
  EXPECT_FALSE(other.is_growing(internal, 10));

  // Activities from outside replace the program from then on.
  Motion motion = at_rest(tissue);
  motion.end_time_s = 5, motion.internal = internal;
  internal =
      law.with_activities(law.next_internal(motion.step()), std::vector<double>{3, GivenActivities::as_programmed});
  tensors.clear();
  law.grow(internal, 20, tensors);
  EXPECT_NEAR(tensors[0].volume, std::exp(0.01 * (5 + 3 * 15)), 1e-14);
  EXPECT_NEAR(tensors[1].volume, std::exp(v), 1e-14);
  EXPECT_EQ(law.activity_of(CellId(0), 7, internal), 3);
}

TEST(CellGrowth, TurnsWithTheCellsOfARoundTissue) {
  const Tissue tissue = build_shell({.length_um = 280, .cells = {9, 9, 8}});
  const CellGrowth law(tissue, CellSet(tissue.cells.size(), true), {1, {0, 0, 1}});
  std::vector<GrowthTensor> tensors;
  law.grow(law.first_internal(tissue), 0.5, tensors);
  for (std::size_t c = 0; c < tensors.size(); ++c) {
    const Vec3 outward = cell_centre(tissue.cells[c], tissue.rest_positions).normalized();
    EXPECT_NEAR(outward.dot(tensors[c].G * outward), std::exp(0.5), 0.02);
    EXPECT_NEAR(tensors[c].G.determinant(), tensors[c].volume, 1e-13);
  }
}

// Faces normal to x, y and z of a cell that grows beside one that does not.
TEST(CellGrowth, RestAreasOfCorticesGrowBySideAndNeighbour) {
  const Tissue tissue = build_block(two_cells);
  std::vector<GrowthTensor> tensors(2);
  tensors[0] = {Vec3(1.5, 1.2, 1.1).asDiagonal(), 1.5 * 1.2 * 1.1};
  for (const CellSide side : {CellSide::apical, CellSide::basal, CellSide::lateral}) {
    const Cortex before(tissue, CellSet{true, true}, {.side = side, .stiffness = 1});
    const std::unique_ptr<Law> law = before.grown(tissue, {}, tensors);
    const Motion rest = at_rest(tissue);
    const std::vector<double> tensions = dynamic_cast<const Cortex&>(*law).tensions(rest.step());
    ASSERT_EQ(tensions.size(), before.faces().size());
    for (std::size_t f = 0; f < tensions.size(); ++f) {
      const Face& face = before.faces()[f];
      const Vec3 normal = facet_area_vector(gather(tissue.rest_positions, face.nodes)).normalized().cwiseAbs();
      const double grown = normal.dot(Vec3(1.2 * 1.1, 1.5 * 1.1, 1.5 * 1.2));
      const double ratio = face.beyond ? 0.5 * (grown + 1) : face.cell == CellId(0) ? grown : 1;
      EXPECT_NEAR(tensions[f], 1 / ratio - 1, 1e-12) << f;
    }
  }
}

// Laws of a grown model are those of the shapes at that time, however many models lie between.
TEST(Grown, DependsOnTheTimeAlone) {
  const Scenario scenario = scenario_of(sheet_table(60, 50, 15, 25) + R"([elasticity]
model = "neo-hookean"
[cortex.a]
region = "all"
stiffness_mN_per_m = 1
relaxation_min = 5
[cortex.w]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.2
saturation_ratio = 0.2
[growth.g]
region = "all"
rate_per_h = 20
in_plane = 0.8
axis = "along"
axis_ratio = 3
variation = { spread = 0.3 })");
  const std::unique_ptr<Model> model = make_model(scenario);
  const std::vector<std::vector<double>> internals = rest_state(*model).internals;
  std::optional<Model> steps;
  for (const double time_s : {30.0, 60.0, 61.0, 100.0}) {
    const Model& present = steps ? *steps : *model;
    steps = grown(*model, present, internals, time_s);
    ASSERT_TRUE(steps);
  }
  EXPECT_FALSE(grown(*model, *steps, internals, 100));
  const std::optional<Model> at_once = grown(*model, *model, internals, 100);
  EXPECT_EQ(steps->tissue.element_rest_shape, at_once->tissue.element_rest_shape);
  EXPECT_TRUE(std::ranges::equal(steps->volumes.targets(), at_once->volumes.targets()));
  Motion motion = random_motion(model->tissue, 0.5, 3);
  for (std::size_t l = 0; l < model->laws.size(); ++l) {
    motion.internal = model->laws[l]->first_internal(model->tissue);
    EXPECT_EQ(forces_of(*steps->laws[l], motion.step()), forces_of(*at_once->laws[l], motion.step()));
  }
}

// A block that slides along three planes, in almost no fluid.
const std::string free_block = block_table(60, 40, 20, "3, 2, 1") + R"([dynamics]
surface_drag_Pa_s_per_um = 1e-6
[hold.x]
region = "all"
directions = ["x"]
x_um = [-31, -29]
[hold.y]
region = "all"
directions = ["y"]
y_um = [-21, -19]
[hold.z]
region = "all"
directions = ["z"]
z_um = [-11, -9]
[cortex.top]
region = "all"
stiffness_mN_per_m = 0.5
[cortex.sides]
region = "all"
faces = "lateral"
stiffness_mN_per_m = 0.5
relaxation_min = 5
[time]
end_min = 60
max_step_s = 300
[stop]
at_equilibrium = false
[growth.g]
region = "all"
)";

double stored_energy(const Simulation& simulation) {
  Step step;
  step.positions = step.previous_positions = simulation.state().positions;
  step.previous_velocities = simulation.state().velocities;
  step.rate_s = 1e-9;
  step.end_time_s = simulation.time_s();
  step.internals = simulation.state().internals;
  double sum = 0;
  for_laws(simulation.model(), step, [&](const Law& law, const Step& own) {
    if (law.name() != "drag") sum += law.energy(own);
  });
  return sum;
}

TEST(Growth, FreeGrowthHasNoStress) {
  int cases = 0;
  for (const std::string model : {"corotational", "neo-hookean", "shape-memory"})
    for (const std::string keys :
         {"rate_per_h = 0.7", "rate_per_h = -0.7\nin_plane = 1", "rate_per_h = 0.5\nin_plane = 0",
          "final_ratio = 1.8\nin_plane = 0.9\naxis = \"across\"\naxis_ratio = 3\nprogram = { time_min = [5, 20, 50], "
          "activity = [0, 1, 0.5] }"}) {
      SCOPED_TRACE(model + ": " + keys);
      Simulation simulation(scenario_of(free_block + keys, {"elasticity.model=" + model}));
      const Model start = simulation.model();
      const double at_start = stored_energy(simulation);
      ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
      const double volume = keys.starts_with("final") ? 1.8 : std::exp(std::stod(keys.substr(13)));
      const std::vector<double> volumes = start.volumes.volumes(simulation.state().positions);
      for (std::size_t c = 0; c < volumes.size(); ++c)
        EXPECT_NEAR(volumes[c] / (start.volumes.targets()[c] * volume), 1, 1e-9);
      EXPECT_NEAR(stored_energy(simulation), at_start, 1e-9 * 48000) << "of a stiffness of 1 nN/um^2";
      std::vector<GrowthTensor> tensors;
      for (std::size_t l = 0; l < start.laws.size(); ++l)
        start.laws[l]->grow(simulation.state().internals[l], 3600, tensors);
      const Mat3 G = tensors[0].G;
      const Vec3 corner(-30, -20, -10);
      double apart = 0;
      for (std::size_t n = 0; n < start.tissue.node_count(); ++n) {
        const Vec3 expected = corner + G * (start.tissue.rest_positions[n] - corner);
        apart = std::max(apart, (simulation.state().positions[n] - expected).norm());
      }
      EXPECT_LE(apart, 1e-6);
      ++cases;
    }
  EXPECT_EQ(cases, 12);
}

// Growth along x by g between two walls; sides are free, and volumes exact: elastic stretches 1/g, sqrt g, sqrt g.
TEST(Growth, AHeldBarHasTheStressOfItsElasticStretch) {
  for (const std::string material : {"neo-hookean", "corotational"})
    for (const double g : {1.05, 1.3, 0.8}) {
      const std::string keys = fmt::format(
          "final_ratio = {}\nin_plane = 1\naxis = \"across\"\naxis_ratio = 0\nprogram = {{ time_min = [0, "
          "20], activity = [1, 1] }}\n[hold.end]\nregion = \"all\"\ndirections = [\"x\"]\nx_um = [29, 31]",
          g);
      Simulation simulation(
          scenario_of(free_block + keys, {"elasticity.model=" + material, "elasticity.poisson_ratio=0.25",
                                          "cortex.top.stiffness_mN_per_m=0", "cortex.sides.stiffness_mN_per_m=0"}));
      ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
      const State& state = simulation.state();
      Vectors forces(state.positions.size(), Vec3::Zero());
      Step step{state.positions, state.positions, state.velocities, 1, state.time_s};
      step.internals = state.internals;
      for_laws(simulation.model(), step, [&](const Law& law, const Step& own) { law.add_forces(own, forces); });
      simulation.model().volumes.add_forces(state.positions, state.multipliers, forces);
      double pull = 0;
      for (std::size_t n = 0; n < forces.size(); ++n)
        if (simulation.model().tissue.rest_positions[n].x() < -29) pull += forces[n].x();
      const double mu = 1 / 2.5, x = 1 / g, y = std::sqrt(g), mean = (x + 2 * y) / 3;
      const double stress =
          material == "neo-hookean" ? mu * (x * x - y * y) : 2 * mu * ((x - mean) * x - (y - mean) * y);
      std::printf("%s, growth %.2f: stress %.6f kPa\n", material.c_str(), g, pull / (800 * g));
      EXPECT_NEAR(pull / (800 * g), stress, 1e-6);
    }
}

const std::string proliferating = sheet_table(50, 40, 12, 20) + R"(elements = "kites"
[elasticity]
model = "neo-hookean"
relaxation_min = 10
[dynamics]
surface_drag_Pa_s_per_um = 10
[cortex.top]
region = "all"
stiffness_mN_per_m = 0.1
tension_mN_per_m = 0.05
[cortex.sides]
region = "all"
faces = "lateral"
stiffness_mN_per_m = 0.02
relaxation_min = 5
[growth.g]
region = "all"
rate_per_h = 3
in_plane = 1
variation = { spread = 0.5 }
[growth.h]
region = "all"
rate_per_h = 0.2
axis = "across"
axis_ratio = 0.5
program = { time_s = [0, 100, 100, 400], activity = [1, 0.5, 2, 1] }
[division.d]
region = "all"
when = "volume_above_um3"
threshold = 1500
daughter_volume_ratio = 0.5
growth_s = 60
plane = "longest-axis"
max_generation = 5
[time]
end_min = 12
[stop]
at_equilibrium = false
)";

TEST(Growth, WithDivisionKeepsVolumesAndResumesBitwiseOnAnyNumberOfThreads) {
  const Scenario scenario = scenario_of(proliferating);
  Simulation whole(scenario);
  std::vector<RunMemory> memories;
  double grown_ratio = 0;
  const auto all = [](std::span<const double> values) { return std::accumulate(values.begin(), values.end(), 0.0); };
  const double at_start = all(whole.model().volumes.targets());
  while (whole.step()) {
    memories.push_back(whole.memory());
    EXPECT_LE(*whole.measures()["max_volume_error"], 1e-9);
  }
  ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  grown_ratio = all(whole.model().volumes.targets()) / at_start;
  std::printf("%zu cells of %d steps, volume x %.3f\n", whole.model().tissue.cells.size(), whole.steps(), grown_ratio);
  EXPECT_GT(whole.model().tissue.cells.size(), 30U);
  EXPECT_NEAR(grown_ratio, std::exp(3.2 / 5), 0.15);
  expect_to_end_alike(scenario, whole, memories, 3, memories.size() / 5);
}

TEST(Growth, CellsDivideInBatchesIfThresholdsAreCheckedSeldom) {
  Simulation simulation(scenario_of(proliferating, {"division.d.every_min=2"}));
  std::size_t cells = simulation.model().tissue.cells.size();
  int batches = 0;
  for (double before_s = 0; simulation.step(); before_s = simulation.time_s()) {
    const std::size_t now = simulation.model().tissue.cells.size();
    if (now == cells) continue;
    EXPECT_GT(std::floor((simulation.time_s() + 1e-6) / 120), std::floor((before_s + 1e-6) / 120));
    EXPECT_GT(now, cells);
    cells = now, ++batches;
  }
  ASSERT_EQ(simulation.status(), RunStatus::end_time) << simulation.failure();
  std::printf("%zu cells after %d batches, in %d steps\n", cells, batches, simulation.steps());
  EXPECT_GE(batches, 3);
  EXPECT_GT(cells, 30U);
}

// What cells have after a cut is what their mother had: volumes, targets, and rest areas of faces that stay.
TEST(Growth, ADivisionChangesNoTargetOfOtherCells) {
  const Scenario scenario = scenario_of(proliferating, {"growth.g.variation.spread=0"});
  const std::unique_ptr<Model> initial = make_model(scenario);
  Model model(*initial);
  State state = rest_state(model), undivided = state;
  const auto wait = [](const Model& of, double time_s, State& until) {
    until.internals = next_internals(
        of, {until.positions, until.positions, until.velocities, 1, time_s, false, {}, 0, until.internals});
    until.time_s = time_s;
  };
  wait(model, 300, state);
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(4), 0}, 100, 0.5}});
  wait(model, 350, state);
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(9), 0}, 0, 0.5}});
  const std::optional<Model> later = grown(model, model, state.internals, 600),
                             alone = grown(*initial, *initial, undivided.internals, 600);
  const std::span<const double> targets = later->volumes.targets(), expected = alone->volumes.targets();
  for (std::size_t c = 0; c < expected.size(); ++c)
    if (c != 4 && c != 9) {
      EXPECT_NEAR(targets[c] / expected[c], 1, 1e-12);
      EXPECT_NEAR(rest_volume(later->tissue, later->tissue.cells[c]) / expected[c], 1, 1e-9);
    }
  // Daughters that grow to half of their mother in 100 s grow by the tables meanwhile and afterwards.
  const std::size_t first = expected.size(), second = first + 1;
  EXPECT_NEAR((targets[4] + targets[first]) / expected[4], 1, 1e-12);
  EXPECT_NEAR((targets[9] + targets[second]) / expected[9], 1, 1e-12);
}

TEST(Growth, OfASideIsThatOfTheWhole) {
  const std::string text = R"(format = 1
[embryo]
length_um = 300
diameter_um = 160
cell_height_um = 30
cells = [12, 8, 8]
[region.belly]
face = "ventral"
cells_across = 4
[vitelline]
enabled = false
[cortex.top]
region = "all"
stiffness_mN_per_m = 1
[growth.g]
region = "belly"
rate_per_h = 3
profile = { shape = "gaussian", sigma_cells = 2 }
[time]
end_s = 60
[stop]
at_equilibrium = false
)";
  Simulation whole(scenario_of(text)), side(scenario_of(text, {"embryo.mirror=[\"x\",\"y\"]"}));
  for (Simulation* simulation : {&whole, &side}) {
    ASSERT_EQ(simulation->run(), RunStatus::end_time) << simulation->failure();
    EXPECT_LE(*simulation->measures()["max_volume_error"], 1e-9);
  }
  EXPECT_TRUE(std::ranges::equal(whole.model().volumes.targets(), side.model().volumes.targets()));
  EXPECT_LE(largest_distance(whole.state().positions, side.state().positions), 0.01);
  const auto [least, most] = std::ranges::minmax(whole.model().volumes.relative_errors(whole.state().positions));
  EXPECT_LE(most - least, 1e-9);
}

TEST(GrowthKeys, ErrorsNameTheRemedy) {
  const std::string table = "[growth.a]\nregion = \"all\"\n";
  const WrongScenarios cases = {
      {table, "1: growth.a: has no effect; set rate_per_h, or final_ratio with a program"},
      {table + "rate_per_h = 1\nfinal_ratio = 2",
       "4: growth.a.final_ratio: conflicts with rate_per_h, which is also set; remove one of them"},
      {table + "final_ratio = 2",
       "1: growth.a.program: is missing: final_ratio is reached over its course; set program, for example to { "
       "time_min = [0, 60], activity = [1, 1] }"},
      {table + "final_ratio = 2\nprogram = { time_s = [0, 9], activity = [0, 0] }",
       "4: growth.a.program.activity: has no integral over time, so final_ratio is never reached; set two times or "
       "more, with an activity above 0"},
      {table + "final_ratio = 0", "3: growth.a.final_ratio: 0 is out of range; set final_ratio to a number > 0"},
      {table + "rate_per_h = 1\nin_plane = 1.5",
       "4: growth.a.in_plane: 1.5 is out of range; set in_plane to a number, 0 to 1 or \"isotropic\""},
      {table + "rate_per_h = 1\naxis = \"along\"",
       "1: growth.a.axis_ratio: is missing; set axis_ratio to growth along the axis / growth across it"},
      {table + "rate_per_h = 1\naxis_ratio = 2", "1: growth.a.axis: is missing; set axis to \"along\" or \"across\""},
      {table + "rate_per_h = 1\nin_plane = 0\naxis = \"along\"\naxis_ratio = 2",
       "6: growth.a.axis_ratio: is not used with in_plane 0, growth in height; remove axis and axis_ratio"},
      {"base = \"drosophila-paper\"\n" + table + "rate_per_h = 1",
       "2: growth.a: the paper's algorithm does not support growth; remove [growth], or set time.scheme to "
       "\"newton\" and volume.method to \"coupled\" or \"none\""},
  };
  expect_errors(cases, load_errors);
}

}  // namespace
