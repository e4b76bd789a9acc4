// Activities, arrays, pulses and divisions in the loop: who acts or divides when, and what a run keeps at every step.
#include "core/errors.hpp"
#include "measure/cells.hpp"
#include "mechanics/active/cell_pattern.hpp"
#include "scenario/load.hpp"
#include "support/divided.hpp"
#include "support/ran.hpp"
#include "support/resumed.hpp"

namespace {

constexpr double as_programmed = GivenActivities::as_programmed;

Scenario block_with(const std::string& tables, const std::vector<std::string>& overrides = {}) {
  return load_scenario(
      {"block", "block",
       "[embryo]\nshape = \"block\"\nlength_um = 100\nwidth_um = 60\ncells = [5, 3, 1]\n[vitelline]\nenabled = "
       "false\n[time]\nend_min = 2\n[stop]\nat_equilibrium = false\n[region.middle]\nx_um = [-30, 30]\n" +
           tables},
      overrides);
}

const std::string springs = "[contraction.apical]\nregion = \"middle\"\nstiffness_nN_per_um = 3\n";
const std::string cortex =
    "[cortex.apical]\nregion = \"middle\"\ntension_mN_per_m = 1\nstiffness_mN_per_m = 1\nrelaxation_s = 60\n";

double farthest(const Simulation& a, const Simulation& b) {
  return largest_distance(a.state().positions, b.state().positions);
}

std::vector<double> all(const Simulation& simulation, double activity) {
  return std::vector<double>(simulation.model().tissue.cells.size(), activity);
}

TEST(GivenActivity, OfOneIsTheProgramOfOne) {
  for (const std::string& tables : {springs, cortex}) {
    const std::string label = (tables == springs ? "contraction" : "cortex") + std::string(".apical");
    Simulation programmed(block_with(tables)), told(block_with(tables)), freed(block_with(tables));
    told.set_activity(label, all(told, 1));
    freed.set_activity(label, all(freed, 0.3));
    freed.set_activity(label, {});
    for (Simulation* simulation : {&programmed, &told, &freed}) simulation->run_until(60);
    EXPECT_EQ(farthest(programmed, told), 0) << label;
    EXPECT_EQ(farthest(programmed, freed), 0) << label;
  }
}

TEST(GivenActivity, OfZeroIsNoContraction) {
  Simulation told(block_with(springs)), none(block_with(springs, {"contraction.apical.stiffness_nN_per_um=0"}));
  told.set_activity("contraction.apical", all(told, 0));
  EXPECT_EQ(told.run(), RunStatus::end_time);
  none.run();
  EXPECT_LE(farthest(told, none), 1e-12);
}

TEST(GivenActivity, IsOfSingleCellsAndIsMeasured) {
  Simulation simulation(block_with(springs));
  std::vector<double> activities = all(simulation, as_programmed);
  activities[7] = 0.25;
  simulation.set_activity("contraction.apical", activities);
  const Law& law = *simulation.model().laws[2];
  ASSERT_EQ(law.label(), "contraction.apical");
  const auto& internal = simulation.state().internals[2];
  EXPECT_EQ(law.activity_of(CellId(7), 0, internal), 0.25);
  EXPECT_EQ(law.activity_of(CellId(6), 0, internal), 1);
  EXPECT_EQ(law.activity_of(CellId(0), 0, internal), std::nullopt);  // not of the region
}

TEST(GivenActivity, GoesAlongIntoCopiesAndCheckpoints) {
  const Scenario scenario = block_with(cortex);
  Simulation first(scenario);
  first.run_until(20);
  first.set_activity("cortex.apical", all(first, 0.4));
  first.step();
  Simulation copy = first, resumed(scenario);
  resumed.go_on_from(first.memory());
  for (Simulation* simulation : {&first, &copy, &resumed}) simulation->run_until(80);
  EXPECT_EQ(farthest(first, copy), 0);
  EXPECT_EQ(farthest(first, resumed), 0);
}

TEST(GivenActivity, OfAMotherIsHerDaughters) {
  const Scenario scenario = block_with(springs + "[division.all]\nregion = \"middle\"\nat_min = 0.5\n");
  Simulation simulation(scenario);
  simulation.set_activity("contraction.apical", all(simulation, 0.6));
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  ASSERT_GT(simulation.divisions(), 0);
  const Model& model = simulation.model();
  const std::size_t law = place_of_law(model, "contraction.apical", true);
  for (std::size_t c = 0; c < model.tissue.cells.size(); ++c)
    if (model.tissue.regions.at("middle")[c]) {
      EXPECT_EQ(model.laws[law]->activity_of(CellId(c), simulation.time_s(), simulation.state().internals[law]), 0.6);
    }
}

TEST(GivenActivity, OfOneSideIsThatOfTheWhole) {
  const auto embryo = [](const std::vector<std::string>& more) {
    std::vector<std::string> overrides = {"time.end_min=1", "embryo.cells=[8,4,4]", "region.furrow.cells_along=4",
                                          "region.furrow.cells_across=2"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_scenario(find_scenario("drosophila"), overrides);
  };
  Simulation whole(embryo({})), half(embryo({"embryo.mirror=[\"y\"]"}));
  for (Simulation* simulation : {&whole, &half}) {
    std::vector<double> activities;
    for (const Cell& cell : simulation->model().tissue.cells)
      activities.push_back(cell_centre(cell, simulation->model().tissue.rest_positions).x() > 0 ? 0.5 : 1.5);
    simulation->set_activity("contraction.apical", activities);
    simulation->run_until(30);
  }
  EXPECT_LE(farthest(whole, half), 0.01);
  std::vector<double> uneven = all(half, 1);
  uneven[0] = 0.5;
  EXPECT_THROW(half.set_activity("contraction.apical", uneven), UsageError);
}

TEST(GivenActivity, IsCheckedAndWakesWhatIsAtRest) {
  Simulation simulation(block_with(springs, {"stop.at_equilibrium=true", "time.end_min=60"}));
  for (const auto& [label, activities] : std::vector<std::pair<std::string, std::vector<double>>>{
           {"contraction.basal", all(simulation, 1)},
           {"corotational", all(simulation, 1)},
           {"contraction.apical", {1, 1}},
           {"contraction.apical", all(simulation, -2)},
           {"contraction.apical", all(simulation, std::numeric_limits<double>::quiet_NaN())}})
    EXPECT_THROW(simulation.set_activity(label, activities), UsageError);
  ASSERT_EQ(simulation.run(), RunStatus::equilibrium);
  const Simulation rest = simulation;
  simulation.set_activity("contraction.apical", all(simulation, 0));
  EXPECT_EQ(simulation.run(), RunStatus::equilibrium);
  EXPECT_GT(farthest(rest, simulation), 0.1);
}

// Of several laws that act on a cell the first by name counts.
TEST(Activities, AreThoseOfTheFirstLawOfACell) {
  const Simulation simulation(
      block_with(springs + "program = { time_s = [0], activity = [0.5] }\n[contraction.basal]\nregion = \"all\"\nedges "
                           "= \"basal\"\nstiffness_nN_per_um = 1\n"));
  const std::vector<double> found = activities(simulation.model(), simulation.state());
  const CellSet& middle = simulation.model().tissue.regions.at("middle");
  for (std::size_t c = 0; c < found.size(); ++c) EXPECT_EQ(found[c], middle[c] ? 0.5 : 1) << c;
}

Scenario row_of_cells(const std::string& more = "") {
  return load_scenario({"row", "row",
                        "[embryo]\nshape = \"block\"\nlength_um = 60\nwidth_um = 20\ncells = [3, 1, "
                        "1]\n[region.middle]\nids = [1]\n[vitelline]\nenabled = false\n[time]\nend_s = 4\n" +
                            more});
}

TEST(CellArray, IsCopiedAndRemembered) {
  Simulation simulation(row_of_cells());
  simulation.set_cell_array("signal", {1, 2, 3});
  simulation.run_until(1);
  Simulation copy(simulation), resumed(row_of_cells());
  resumed.go_on_from(simulation.memory());
  for (const Simulation* one : {&copy, &resumed}) EXPECT_EQ(one->outside_arrays().at("signal"), (CellArray{1, 2, 3}));
  copy.set_cell_array("signal", {0, 0, 0});
  EXPECT_EQ(simulation.outside_arrays().at("signal"), (CellArray{1, 2, 3}));
}

TEST(CellArray, IsInheritedByDaughters) {
  Simulation simulation(row_of_cells("[division.middle]\nregion = \"middle\"\nplane = \"transverse\"\nat_s = 2\n"));
  simulation.set_cell_array("signal", {1, 2, 3});
  simulation.run();
  EXPECT_EQ(simulation.divisions(), 1);
  EXPECT_EQ(simulation.outside_arrays().at("signal"), (CellArray{1, 2, 3, 2}));
}

TEST(CellArray, ThatFitsNoCellIsRefused) {
  Simulation simulation(row_of_cells());
  const auto refused = [&](const std::string& name, const CellArray& values, const std::string& said) {
    EXPECT_SAYS(error_of<UsageError>([&] { simulation.set_cell_array(name, values); }), said);
  };
  refused("signal", {1, 2}, "2 values for 3 cells");
  refused("signal", {1, 2, std::numeric_limits<double>::quiet_NaN()}, "the value of cell 2 is nan");
  refused("x_um", {1, 2, 3}, "is an output variable");
  refused("region_middle", {1, 2, 3}, "is an output variable");
  refused("a\nb", {1, 2, 3}, "control characters");
  EXPECT_TRUE(simulation.outside_arrays().empty());
  RunMemory memory = simulation.memory();
  memory.outside_arrays["signal"] = {1};
  EXPECT_THROW(simulation.go_on_from(memory), UnfitMemory);
}

const std::string pulsing = R"(format = 1
[embryo]
length_um = 300
diameter_um = 160
cell_height_um = 30
cells = [8, 6, 6]
[region.belly]
face = "ventral"
cells_across = 4
[dynamics]
surface_drag_Pa_s_per_um = 20
[cortex.apical]
region = "belly"
tension_mN_per_m = 2
pulse = { period_s = 40, amplitude = 0.8, seed = 3 }
[contraction.walls]
region = "belly"
edges = "lateral"
stiffness_nN_per_um = 0.5
pulse = { period_s = 25, amplitude = 0.5, phase = "together" }
[time]
end_s = 60
)";

Scenario pulsing_with(const std::vector<std::string>& overrides) {
  return load_scenario({"test", "test.toml", pulsing}, overrides);
}

Vectors end_of(const std::vector<std::string>& overrides) {
  Simulation simulation(pulsing_with(overrides));
  EXPECT_EQ(simulation.run(), RunStatus::end_time);
  return simulation.state().positions;
}

// Backward Euler errs in proportion to its step: half the step, half the difference.
TEST(Pulses, HalfTheStepHalvesTheError) {
  const std::string first_order = "time.integrator=backward-euler";
  const Vectors two = end_of({first_order, "time.step_s=2"}), one = end_of({first_order, "time.step_s=1"}),
                half = end_of({first_order, "time.step_s=0.5"});
  const double coarse = largest_distance(two, one), fine = largest_distance(one, half);
  EXPECT_GT(coarse, 0.01);
  EXPECT_NEAR(coarse / fine, 2, 0.3);
  // Adaptive steps agree within some times their tolerance.
  EXPECT_LT(largest_distance(end_of({"time.tolerance_um=0.005"}), half), 2 * fine + 0.1);
}

TEST(Pulses, StepsSeeThemAndTheRunGoesOn) {
  Simulation simulation(pulsing_with({"stop.equilibrium_speed_um_per_min=1e6"}));
  double time_s = 0, longest = 0, least = 2, most = 0;
  while (simulation.step()) {
    longest = std::max(longest, simulation.state().time_s - std::exchange(time_s, simulation.state().time_s));
    const std::vector<double> activity = activities(simulation.model(), simulation.state());
    const std::vector<double> strength = strengths(simulation.model());
    const CellSet& belly = simulation.model().tissue.regions.at("belly");
    for (std::size_t c = 0; c < belly.size(); ++c) {
      EXPECT_EQ(strength[c], belly[c] ? 1 : 0);
      if (!belly[c]) continue;
      least = std::min(least, activity[c]);
      most = std::max(most, activity[c]);
    }
  }
  EXPECT_NEAR(time_s, 60, 1e-9);  // with a speed that everything is slower than it would have ended at once
  EXPECT_LE(longest, 25.0 / 12 + 1e-9);
  EXPECT_LT(least, 0.6);
  EXPECT_GT(most, 1.4);
}

TEST(Pulses, ResumedRunsGoOnToTheSameBits) {
  Simulation whole(pulsing_with({}));
  whole.run_until(20);
  const RunMemory memory = whole.memory();
  whole.run();
  Simulation rest(pulsing_with({}));
  rest.go_on_from(memory);
  rest.run();
  expect_same(rest.state(), whole.state());
}

Model row_model(int cells) {
  Model model(build_block({.length_um = 20.0 * cells, .width_um = 20, .cell_height_um = 40, .cells = {cells, 1, 1}}));
  add_elasticity(model);
  add_drag(model);
  return model;
}

DivisionRule at(double time_s, const std::string& region, double growth_s, DivisionPlane plane) {
  return {.region = region, .threshold = time_s, .plane = plane, .growth_s = growth_s, .max_generation = 100};
}

RunControls controls_of(std::vector<DivisionRule> rules) {
  RunControls controls{.max_step_s = 200, .end_s = 20000, .equilibrium_speed_um_per_s = 1e-7};
  for (const DivisionRule& rule : rules)
    if (rule.trigger == DivisionTrigger::time) controls.program_points_s.push_back(rule.threshold);
  controls.divisions = std::move(rules);
  return controls;
}

// What holds at every step of a run with divisions.
struct Kept {
  double volume_error = 0;  // of cells against their targets
  double gap = 0;           // sum of cells over the volume inside the boundary, less 1
  int steps = 0;

  StepWatcher watcher() {
    return [&](const AcceptedStep& step, const Model& model) {
      for (const double error : model.volumes.relative_errors(step.state.positions))
        volume_error = std::max(volume_error, std::abs(error));
      const double inside = volume_inside_boundary(model.tissue, step.state.positions);
      gap = std::max(gap, std::abs(volume_of_cells(model.tissue, step.state.positions) / inside - 1));
      ++steps;
    };
  }
};

// Lengths of the twelve edges of a cell, in order.
std::vector<double> edge_lengths(const Cell& cell, const Vectors& positions) {
  std::vector<double> lengths;
  for (const auto& [a, b] : hex_edges)
    lengths.push_back((positions[cell.corners[b].index()] - positions[cell.corners[a].index()]).norm());
  return lengths;
}

TEST(DivisionRun, FreeDaughtersEndWithTheirMothersShapeAndVolume) {
  for (const DivisionPlane plane : {DivisionPlane::transverse, DivisionPlane::sagittal}) {
    Model model = row_model(3);
    model.tissue.regions["middle"] = {false, true, false};
    Kept kept;
    const auto mother = edge_lengths(model.tissue.cells[1], model.tissue.rest_positions);
    const Simulation result = ran(std::move(model), controls_of({at(60, "middle", 300, plane)}), kept.watcher());
    EXPECT_EQ(result.status(), RunStatus::equilibrium);
    const Tissue& tissue = result.model().tissue;
    ASSERT_EQ(tissue.cells.size(), 4u);
    EXPECT_EQ(result.divisions(), 1);
    EXPECT_LE(kept.volume_error, 1e-9);
    EXPECT_LE(kept.gap, 1e-12);
    double shape = 0;
    for (const int daughter : {1, 3}) {
      const Cell& cell = tissue.cells[daughter];
      EXPECT_NEAR(cell_volume(tissue, cell, result.state().positions) / 16000, 1, 1e-9);
      const auto lengths = edge_lengths(cell, result.state().positions);
      for (int e = 0; e < 12; ++e) shape = std::max(shape, std::abs(lengths[e] / mother[e] - 1));
    }
    // Along the row the ends are free; side by side the two are held together by neighbours that stay narrow.
    if (plane == DivisionPlane::transverse) {
      EXPECT_LE(shape, 0.01);
    }
    std::cout << kept.steps << " steps: volumes to " << kept.volume_error << ", gap " << kept.gap
              << ", daughters' edges off by " << shape << "\n";
  }
}

TEST(DivisionRun, FourParallelSlicesOfOneCellGrowOneAfterTheOther) {
  Model model = row_model(1);
  Kept kept;
  const Simulation result =
      ran(std::move(model),
          controls_of({at(10, "all", 300, DivisionPlane::transverse), at(100, "all", 200, DivisionPlane::transverse)}),
          kept.watcher());
  EXPECT_EQ(result.status(), RunStatus::equilibrium);
  EXPECT_EQ(result.divisions(), 3);
  ASSERT_EQ(result.model().tissue.cells.size(), 4u);
  EXPECT_LE(kept.volume_error, 1e-9);
  EXPECT_LE(kept.gap, 1e-12);
  double extent = 0;
  for (const Vec3& x : result.state().positions) extent = std::max(extent, std::abs(x.x()));
  EXPECT_NEAR(extent, 40, 0.4);  // four cells of 20 um in a row
  std::cout << kept.steps << " steps: volumes to " << kept.volume_error << ", gap " << kept.gap << "\n";
}

TEST(DivisionRun, ByThresholdEndsWithTheLastGenerationAllowed) {
  for (const auto& [trigger, threshold] :
       {std::pair{DivisionTrigger::volume, 15000.0}, {DivisionTrigger::apical_area, 390.0}}) {
    Model model = row_model(2);
    DivisionRule rule = at(threshold, "all", 100, DivisionPlane::transverse);
    rule.trigger = trigger;
    rule.max_generation = 2;
    Kept kept;
    const Simulation result = ran(std::move(model), controls_of({rule}), kept.watcher());
    EXPECT_EQ(result.model().tissue.cells.size(), 8u);
    EXPECT_EQ(result.divisions(), 6);
    EXPECT_EQ(result.status(), RunStatus::equilibrium);
    for (const Cell& cell : result.model().tissue.cells) EXPECT_EQ(cell.lineage.generation, 2);
    EXPECT_LE(kept.volume_error, 1e-9);
  }
}

TEST(DivisionRun, ByElongationCutsTheLongerSide) {
  Model model(build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  add_elasticity(model);
  add_drag(model);
  DivisionRule rule = at(2, "all", 10, DivisionPlane::longest_axis);
  rule.trigger = DivisionTrigger::elongation;
  rule.volume_ratio = 0.5;
  const Simulation result = ran(std::move(model), controls_of({rule}));
  const Tissue& tissue = result.model().tissue;
  ASSERT_EQ(tissue.cells.size(), 2u);  // 30 by 20: not elongated enough to go on
  EXPECT_NEAR(cell_centre(tissue.cells[0], tissue.rest_positions).x(), -15, 1e-9);
}

// 3 steps of 0.7 s are 4e-16 s short of 2.1 s.
TEST(DivisionRun, ATimeHasComeWhateverRoundingSays) {
  const Model model = row_model(1);
  const std::vector<DivisionRule> rules = {at(2.1, "all", 10, DivisionPlane::transverse)};
  State state = rest_state(model);
  state.time_s = 0.7 + 0.7;
  EXPECT_TRUE(due_divisions(model, state, rules).empty());
  state.time_s = 3 * 0.7;
  ASSERT_LT(state.time_s, 2.1);
  EXPECT_EQ(due_divisions(model, state, rules).size(), 1u);
  state.divided_until_s = state.time_s;
  state.time_s = 4 * 0.7;
  EXPECT_TRUE(due_divisions(model, state, rules).empty());
}

TEST(DivisionRun, ACellThatLeavesDoesNotDivide) {
  Model model = row_model(3);
  model.tissue.regions["first"] = {true, false, false};
  const std::vector<DivisionRule> rules = {at(0, "all", 10, DivisionPlane::transverse)};
  const State state = rest_state(model);
  const double area = face_areas(model.tissue, CellSide::apical, state.positions).front();
  const auto due_beside = [&](const ExtrusionRule& rule) {
    return due_divisions(model, state, rules, std::array{rule}).size();
  };
  EXPECT_EQ(due_beside({"first", 0.99 * area}), 3u);
  EXPECT_EQ(due_beside({"first", 1.01 * area}), 2u);
  EXPECT_EQ(due_beside({"all", 1.01 * area}), 0u);
}

TEST(DivisionRun, EquilibriumCountsAfterTheLastDivision) {
  Model model = row_model(1);
  RunControls controls = controls_of({at(500, "all", 100, DivisionPlane::transverse)});
  controls.program_points_s.clear();  // as of a threshold: nobody knows of it beforehand
  controls.stop_at_equilibrium = false;
  controls.end_s = 3000;
  std::optional<double> first_at_rest_s;
  const Simulation result = ran(std::move(model), controls, [&](const AcceptedStep& step, const Model&) {
    if (step.at_equilibrium && !first_at_rest_s) first_at_rest_s = step.state.time_s;
  });
  EXPECT_EQ(result.divisions(), 1);
  EXPECT_LT(first_at_rest_s.value(), 500);
  EXPECT_GT(result.equilibrium_time_s().value(), 600);
}

}  // namespace
