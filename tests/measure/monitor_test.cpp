// Monitors and the criteria that end a run by them.
#include "measure/monitor.hpp"

#include "measure/stop_rule.hpp"
#include "support/divided.hpp"
#include "support/forces_of_cells.hpp"
#include "support/loads.hpp"

namespace {

/// Three cells of 20 x 20 x 40 um along x; "left" is the first, nodes at x = -30 and -10.
Model row_of_three() {
  Model model(build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}}));
  model.tissue.regions["left"] = {true, false, false};
  return model;
}

Monitor monitor_of(const char* quantity, const std::string& region = "left") {
  Monitor monitor;
  monitor.name = "m";
  monitor.quantity = quantity_named(quantity);
  monitor.region = region;
  return monitor;
}

double number(const Monitor& monitor, const Model& model, const State& state) {
  return read_monitor(monitor, {model, state}).number.value();
}

TEST(Monitor, EveryQuantityHasItsNameAndColumn) {
  int count = 0;
  for (const Quantity& info : quantities()) {
    EXPECT_EQ(quantity_named(info.name), &info) << info.name;
    ++count;
  }
  std::cout << count << " quantities\n";
  EXPECT_EQ(quantity_named("sped"), nullptr);
  EXPECT_EQ(monitor_of("velocity").column(), "m.velocity_um_per_s");
  EXPECT_EQ(monitor_of("relative_energy_norm").column(), "m.relative_energy_norm");
  EXPECT_EQ(monitor_of("wall").column(), "m.wall_s");
}

// 5 Pa on the apical side: the nodes at both ends carry the area of a quarter of one cell, the others that of two.
TEST(Monitor, ReadsLoadAndDisplacementInwards) {
  Model model = row_of_three();
  const Vectors& rest = model.tissue.rest_positions;
  Vectors loads(rest.size(), Vec3::Zero());
  State state = rest_state(model);
  for (std::size_t n = 0; n < rest.size(); ++n) {
    if (rest[n].z() < 0) continue;
    loads[n].z() = -0.005 * (std::abs(rest[n].x()) > 20 ? 100 : 200);
    state.positions[n] += Vec3(7, 0, rest[n].x() < -20 ? -4 : -2);
  }
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  EXPECT_NEAR(number(monitor_of("apical_load"), model, rest_state(model)), 5, 1e-12);
  EXPECT_NEAR(number(monitor_of("inward_displacement"), model, state), 3, 1e-12);
  EXPECT_EQ(monitor_of("apical_load").column(), "m.apical_load_Pa");
}

TEST(Monitor, CombinesValues) {
  const std::vector<double> values = {3, -4, 1};
  EXPECT_EQ(combined(Over::mean, values), 0);
  EXPECT_EQ(combined(Over::max, values), 3);
  EXPECT_EQ(combined(Over::min, values), -4);
  EXPECT_EQ(combined(Over::sum, values), 0);
  EXPECT_EQ(combined(Over::rms, values), std::sqrt(26 / 3.0));
  for (const Over over : {Over::mean, Over::max, Over::min, Over::sum, Over::rms}) EXPECT_FALSE(combined(over, {}));
}

TEST(Monitor, ReadsNodesOfItsRegionAndSide) {
  const Model model = row_of_three();
  Monitor monitor = monitor_of("displacement");
  EXPECT_EQ(monitored_nodes(monitor, model.tissue).size(), 8U);
  const double bottom = model.tissue.rest_positions[model.tissue.cells[0].corners[0].index()].z();
  for (const auto& [face, height] : {std::pair(CellSide::apical, 40.0), {CellSide::basal, 0.0}}) {
    monitor.face = face;
    const auto nodes = monitored_nodes(monitor, model.tissue);
    ASSERT_EQ(nodes.size(), 4U);
    for (const NodeId node : nodes) EXPECT_EQ(model.tissue.rest_positions[node.index()].z() - bottom, height);
  }
}

TEST(Monitor, MotionOfNodesByNormAndComponent) {
  const Model model = row_of_three();
  State state = rest_state(model);
  for (std::size_t n = 0; n < state.positions.size(); ++n) {
    state.positions[n] += Vec3(3, 0, -4);
    state.velocities[n] = Vec3(0, -0.6, 0.8);
  }
  EXPECT_NEAR(number(monitor_of("displacement"), model, state), 5, 1e-12);
  EXPECT_NEAR(number(monitor_of("speed"), model, state), 1, 1e-12);
  Monitor along = monitor_of("displacement");
  along.axis = 2;
  EXPECT_NEAR(number(along, model, state), -4, 1e-12);
  along.quantity = quantity_named("velocity");
  along.axis = 1;
  EXPECT_NEAR(number(along, model, state), -0.6, 1e-12);
  // Nodes of the left cell lie at two places in x, shifted by 3.
  along.quantity = quantity_named("position");
  along.axis = 0;
  const double first = model.tissue.rest_positions[0].x();
  EXPECT_NEAR(number(along, model, state), first + 10 + 3, 1e-12);
  along.over = Over::max;
  EXPECT_NEAR(number(along, model, state), first + 20 + 3, 1e-12);
}

TEST(Monitor, VolumeOfAnInvertedCellIsNegative) {
  const Model model = row_of_three();
  State state = rest_state(model);
  EXPECT_NEAR(number(monitor_of("volume"), model, state), 16000, 1e-9);
  for (Vec3& x : state.positions) x.z() = -x.z();  // the mirror image: inside out
  EXPECT_NEAR(number(monitor_of("volume"), model, state), -16000, 1e-9);
  Monitor all = monitor_of("volume", "all");
  all.over = Over::sum;
  EXPECT_NEAR(number(all, model, state), -48000, 1e-9);
}

TEST(Monitor, AreaOfEitherSide) {
  const Model model = row_of_three();
  State state = rest_state(model);
  const double top = model.tissue.rest_positions[model.tissue.cells[0].corners[4].index()].z();
  for (Vec3& x : state.positions)
    if (x.z() == top) x.y() *= 0.5;
  Monitor monitor = monitor_of("area", "all");
  EXPECT_NEAR(number(monitor, model, state), 200, 1e-10);
  monitor.face = CellSide::basal;
  EXPECT_NEAR(number(monitor, model, state), 400, 1e-10);
  monitor.over = Over::sum;
  EXPECT_NEAR(number(monitor, model, state), 1200, 1e-10);
  EXPECT_NEAR(number(monitor_of("area_ratio", "all"), model, state), 0.5, 1e-12);
}

// Stretched along x by 3, and narrowed to a half: six times as long as wide. An apex that stands on its end has no
// elongation, and the mean is of the others.
TEST(Monitor, ElongationIsLengthAlongTheAxisOverWidthAcross) {
  const Model model = row_of_three();
  State state = rest_state(model);
  const Monitor monitor = monitor_of("apical_elongation", "all");
  const double at_rest = number(monitor, model, state);
  for (Vec3& x : state.positions) x.x() *= 3, x.y() *= 0.5;
  EXPECT_NEAR(number(monitor, model, state), 6 * at_rest, 1e-12);
  for (const NodeId node : model.tissue.cells[0].apical_corners())
    state.positions[node.index()].x() = state.positions[model.tissue.cells[0].corners[4].index()].x();
  EXPECT_LT(read_monitor(monitor, {model, state}).values.size(), 3U);
}

TEST(Monitor, CellsOfALowerLayerHaveNoApicalArea) {
  const Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 2}}));
  Monitor monitor = monitor_of("area", "all");
  EXPECT_EQ(monitored_cells(monitor, model.tissue).size(), 1U);
  monitor.quantity = quantity_named("area_ratio");
  EXPECT_EQ(number(monitor, model, rest_state(model)), 1);
  monitor.quantity = quantity_named("volume");
  EXPECT_EQ(monitored_cells(monitor, model.tissue).size(), 2U);
}

TEST(Monitor, PressureIsInPascalAndOnlyWhereVolumesAreHeld) {
  Model model = row_of_three();
  State state = rest_state(model);
  state.multipliers = {0.25, 7, 7};  // kPa
  EXPECT_NEAR(number(monitor_of("pressure"), model, state), 250, 1e-9);
  model.volumes.hold(false);
  EXPECT_FALSE(read_monitor(monitor_of("pressure"), {model, state}).number);
}

// A spring on each of four apical edges, 20 um long, k = 2 nN/um: 40 nN along each of two edges at every corner. The
// body moves, is dragged and heavy: that does not count.
TEST(Monitor, ForceIsThatOfTheStandingBody) {
  Model model(build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  add_elasticity(model);
  add_contraction(model, {true}, {.stiffness = 2});
  add_drag(model);
  model.laws.push_back(std::make_unique<Inertia>(model.tissue, 1e-3));
  State state = rest_state(model);
  for (Vec3& v : state.velocities) v = Vec3(1, 2, 3);
  Monitor monitor = monitor_of("force", "all");
  monitor.face = CellSide::apical;
  EXPECT_NEAR(number(monitor, model, state), 40 * std::sqrt(2.0), 1e-9);
  monitor.face = CellSide::basal;
  EXPECT_NEAR(number(monitor, model, state), 0, 1e-9);
  // Elasticity counts, too: stretched along z, the body pulls its top down. Contractions lie across.
  for (Vec3& x : state.positions) x.z() *= 1.1;
  monitor.axis = 2;
  EXPECT_GT(number(monitor, model, state), 1);
}

TEST(Monitor, KineticEnergyOfARegion) {
  Model model = row_of_three();
  const Moment moment_without_mass{model, rest_state(model)};
  EXPECT_FALSE(read_monitor(monitor_of("kinetic_energy"), moment_without_mass).number);
  model.laws.push_back(std::make_unique<Inertia>(model.tissue, 1e-3));  // g/um^3
  State state = rest_state(model);
  for (Vec3& v : state.velocities) v = Vec3(0, 3, 4);
  EXPECT_NEAR(number(monitor_of("kinetic_energy"), model, state), 0.5 * 16 * 25, 1e-9);
  EXPECT_NEAR(number(monitor_of("kinetic_energy", "all"), model, state), 3 * 0.5 * 16 * 25, 1e-9);
}

TEST(Monitor, TimeAndComputingTime) {
  const Model model = row_of_three();
  State state = rest_state(model);
  state.time_s = 12.5;
  EXPECT_EQ(read_monitor(monitor_of("time"), {model, state, 3}).number, 12.5);
  EXPECT_EQ(read_monitor(monitor_of("wall"), {model, state, 3}).number, 3);
}

TEST(Monitor, DeviationAndEnergyNormAgainstTheEndOfARun) {
  const Model model = row_of_three();
  const Tissue& tissue = model.tissue;
  State state = rest_state(model);
  Frame frame;
  frame.elements = tissue.elements;
  for (const Vec3& x : tissue.rest_positions) frame.positions.push_back(1.2 * x);
  for (Vec3& x : state.positions) x *= 1.1;

  Monitor deviation = monitor_of("deviation", "all");
  deviation.reference_frame = frame;
  double sum = 0;
  for (const Vec3& x : tissue.rest_positions) sum += 0.1 * x.norm();
  EXPECT_NEAR(number(deviation, model, state), sum / static_cast<double>(tissue.node_count()), 1e-12);
  deviation.axis = 0;
  deviation.over = Over::min;  // with its sign
  EXPECT_LT(number(deviation, model, state), 0);

  // Half the strain of the reference: half its energy norm, in any region.
  Monitor norm = monitor_of("relative_energy_norm", "left");
  norm.poisson_ratio = 0.45;
  norm.reference_frame = frame;
  EXPECT_NEAR(number(norm, model, state), 0.5, 1e-12);
  norm.reference_frame->positions = tissue.rest_positions;
  EXPECT_FALSE(read_monitor(norm, {model, state}).number) << "nothing is relative to rest";

  // Another mesh: no value.
  deviation.reference_frame->elements.pop_back();
  EXPECT_FALSE(read_monitor(deviation, {model, state}).number);
}

// What two halves of a body exert adds up to what the whole does, springs, pressures and hanging nodes included.
TEST(ForcesOfCells, OfPartsAddUpToThoseOfTheWhole) {
  Model model(distorted_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}}, 1, 3));
  add_elasticity(model);
  add_contraction(model, CellSet(12, true), {.stiffness = 2, .across_ratio = 0.4});
  add_drag(model);
  Random random(5);
  State state = rest_state(model);
  for (double& pressure : state.multipliers) pressure = random.number();
  divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
  for (Vec3& x : state.positions) x += random.vector(0.5);
  model.tissue.place_hanging(state.positions);
  const std::size_t cells = model.tissue.cells.size();
  CellSet left(cells, false), right(cells, false);
  for (std::size_t c = 0; c < cells; ++c) (c % 3 == 0 ? left : right)[c] = true;
  const Vectors of_left = forces_of_cells(model, state, left), of_right = forces_of_cells(model, state, right);
  const Vectors of_all = forces_of_cells(model, state, CellSet(cells, true));
  for (std::size_t n = 0; n < of_all.size(); ++n)
    EXPECT_LE((of_left[n] + of_right[n] - of_all[n]).norm(), 1e-12 * largest(of_all));

  Vectors expected(of_all.size(), Vec3::Zero());
  const Vectors no_velocity(of_all.size(), Vec3::Zero());
  const Step still{state.positions, state.positions, no_velocity, 1, 0};
  for (const auto& law : model.laws) law->add_forces(still, expected);
  model.volumes.add_forces(state.positions, state.multipliers, expected);
  model.tissue.carry_hanging(expected);
  for (std::size_t n = 0; n < of_all.size(); ++n) EXPECT_LE((of_all[n] - expected[n]).norm(), 1e-12 * largest(of_all));
}

// A monitor keeps the laws of its cells from step to step, but not over a division or for another model.
TEST(ForcesOfCells, AreThoseOfThePresentModel) {
  Model model(distorted_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}}, 1, 3));
  model.tissue.regions["left"] = CellSet(12, false);
  model.tissue.regions["left"][0] = model.tissue.regions["left"][5] = true;
  add_elasticity(model);
  add_contraction(model, CellSet(12, true), {.stiffness = 2, .across_ratio = 0.4});
  Random random(5);
  State state = rest_state(model);
  Monitor kept = monitor_of("force", "all");
  kept.from = "left";
  const auto expect_as_anew = [&](const Model& now) {
    Monitor rebuilt = monitor_of("force", "all");
    rebuilt.from = "left";
    EXPECT_EQ(read_monitor(kept, {now, state}).values, read_monitor(rebuilt, {now, state}).values);
    EXPECT_TRUE(kept.apart->are_of(now));
  };
  for (int step = 0; step < 3; ++step) {
    for (Vec3& x : state.positions) x += random.vector(0.5);
    model.tissue.place_hanging(state.positions);
    const CellsApart* before = kept.apart.get();
    expect_as_anew(model);
    EXPECT_EQ(kept.apart.get() == before, step == 1) << "kept from one step to the next, but not over the division";
    if (step == 1) divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
  }
  const Model copy(model);
  EXPECT_FALSE(kept.apart->are_of(copy));
  expect_as_anew(copy);
}

Reading reading(std::vector<double> values) {
  const auto number = combined(Over::mean, values);
  return {std::move(values), number};
}

Criterion above(double bound, Criterion::Over over = Criterion::Over::number) { return {"c", 0, bound, {}, over}; }

TEST(StopRule, ABoundOnTheNumberOnAnyAndOnAll) {
  const Reading values = reading({1, 2, 9});  // mean 4
  using Over = Criterion::Over;
  EXPECT_TRUE(above(3.9).is_met(values));
  EXPECT_FALSE(above(4).is_met(values)) << "beyond, not at";
  EXPECT_TRUE(above(8, Over::any).is_met(values)) << "one suffices";
  EXPECT_FALSE(above(9, Over::any).is_met(values));
  EXPECT_TRUE(above(0.5, Over::all).is_met(values));
  EXPECT_FALSE(above(1, Over::all).is_met(values)) << "one is missing";
  const Criterion below{"c", 0, {}, 2, Over::any};
  EXPECT_TRUE(below.is_met(values));
  EXPECT_FALSE(below.is_met(reading({2, 3})));
  const Criterion between{"c", 0, 3, 5, Over::number};
  EXPECT_TRUE(between.is_met(values));
  EXPECT_FALSE(between.is_met(reading({5})));
  EXPECT_FALSE(between.is_met(reading({3})));
}

TEST(StopRule, WhatHasNoValueMeetsNothing) {
  for (const auto over : {Criterion::Over::number, Criterion::Over::any, Criterion::Over::all})
    EXPECT_FALSE(above(-1e300, over).is_met(reading({})));
}

TEST(StopRule, CombinesCriteriaAndRest) {
  StopRule rule;
  EXPECT_FALSE(rule.is_over(0, true)) << "without criteria, the loop decides";
  rule.criteria = {{"high", 0, 10, {}, {}}, {"low", 1, {}, 1, {}}};
  const std::vector<Reading> one = {reading({11}), reading({2})}, both = {reading({11}), reading({0})};
  EXPECT_EQ(rule.met(one), std::vector<std::string>{"high"});
  EXPECT_EQ(rule.met(both), (std::vector<std::string>{"high", "low"}));
  EXPECT_TRUE(rule.is_over(1, false));
  EXPECT_FALSE(rule.is_over(0, true));
  rule.all = true;
  EXPECT_FALSE(rule.is_over(1, true));
  EXPECT_TRUE(rule.is_over(2, false));
  rule.needs_rest = true;
  EXPECT_FALSE(rule.is_over(2, false));
  EXPECT_TRUE(rule.is_over(2, true));
}

}  // namespace
