// Springs and drag to the reference faces: derivatives, a block pressed onto a Winkler foundation, and what a division
// leaves.
#include "mechanics/foundation.hpp"

#include "mechanics/exchange.hpp"
#include "support/divided.hpp"
#include "support/law_checks.hpp"
#include "support/prisms.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"
#include "support/turns.hpp"

namespace {

using Resists = FoundationRule::Resists;

constexpr double winkler = 0.02;  // nN/um^3

FoundationRule basal_springs(Resists resists, double drag = 0, Program program = {}) {
  return {CellSide::basal, winkler, drag, resists, std::move(program)};
}

TEST(Foundation, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  for (const Resists resists : {Resists::all, Resists::normal, Resists::one_sided}) {
    const Foundation law(tissue, CellSet{true, false}, basal_springs(resists, 0.1, Program({0, 2}, {0.2, 1})));
    check_derivatives(law, tissue, 4);
    check_semidefinite_tangent(law, tissue, 4, false);
  }
}

TEST(Foundation, EnergyFlowIsTheWorkOfItsForces) {
  const Tissue tissue = distorted_block(two_cells, 2, 2);
  for (const Resists resists : {Resists::all, Resists::normal})
    check_energy_flow(Foundation(tissue, CellSet{true, true}, basal_springs(resists, 0.1)), tissue);
}

TEST(Foundation, AtReferenceThereIsNoForce) {
  const Tissue tissue = distorted_block(two_cells, 2, 3);
  for (const Resists resists : {Resists::all, Resists::normal, Resists::one_sided}) {
    const Foundation law(tissue, CellSet{true, true}, basal_springs(resists, 0.1));
    EXPECT_EQ(largest(forces_of(law, at_rest(tissue).step())), 0);
    EXPECT_EQ(law.energy(at_rest(tissue).step()), 0);
  }
}

// 40 x 20 um of base: force k A u along z, and along x where faces cannot slide; a lifted base is free if one-sided.
TEST(Foundation, ForceIsModulusTimesAreaTimesResistedDisplacement) {
  const Tissue tissue = build_block(two_cells);
  for (const auto& [resists, moved, expected] :
       std::vector<std::tuple<Resists, Vec3, Vec3>>{{Resists::all, {1, 0, -2}, {-1, 0, 2}},
                                                    {Resists::normal, {1, 0, -2}, {0, 0, 2}},
                                                    {Resists::normal, {1, 0, 2}, {0, 0, -2}},
                                                    {Resists::one_sided, {1, 0, -2}, {0, 0, 2}},
                                                    {Resists::one_sided, {1, 0, 2}, {0, 0, 0}}}) {
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x += moved;
    motion.previous_positions = motion.positions;
    const Foundation law(tissue, CellSet{true, true}, basal_springs(resists, 0.1));
    EXPECT_LE((resultant(forces_of(law, motion.step())) - winkler * 800 * expected).norm(), 1e-11);
  }
}

TEST(Foundation, DragIsTimesAreaAndSpeedAndItsProgramScalesSprings) {
  const Tissue tissue = build_block(two_cells);
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x += Vec3(0, 0, -2);
  motion.rate_s = 0.5, motion.end_time_s = 1;
  const Foundation law(tissue, CellSet{true, false}, basal_springs(Resists::normal, 0.1, Program({0, 2}, {0, 1})));
  EXPECT_LE((resultant(forces_of(law, motion.step())) - 400 * Vec3(0, 0, 0.5 * winkler * 2 + 0.1 * 4)).norm(), 1e-11);
}

// Anchors, areas and normals of new nodes lie between those of old ones, also where the tissue has moved meanwhile.
TEST(Foundation, ADivisionChangesNoForceOnASheetThatMovesAsOne) {
  Model model(build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}}));
  model.laws.push_back(std::make_unique<Foundation>(model.tissue, CellSet(12, true), basal_springs(Resists::all)));
  State state = rest_state(model);
  for (Vec3& x : state.positions) x += Vec3(1, 2, 3);
  Random random(5);
  for (int round = 0; round < 3; ++round) {
    divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
    Motion motion = at_rest(model.tissue);
    motion.positions = motion.previous_positions = state.positions;
    const Vectors forces = forces_of(*model.laws[0], motion.step());
    EXPECT_LE((resultant(forces) + winkler * 4800 * Vec3(1, 2, 3)).norm(), 1e-9);
  }
  EXPECT_GT(model.tissue.cells.size(), 20U);
  const std::unique_ptr<Law> again = model.laws[0]->restored(model.tissue, no_change(model.tissue),
                                                             model.tissue.rest_positions, model.laws[0]->past());
  const Motion motion = random_motion(model.tissue, 3, 6);
  EXPECT_EQ(forces_of(*again, motion.step()), forces_of(*model.laws[0], motion.step()));
  EXPECT_THROW((void)model.laws[0]->restored(model.tissue, no_change(model.tissue), {}, std::vector<double>(3)),
               InvalidNumbers);
}

TissueChange turn(Model& model, State& state, std::vector<WallTurn>& turns) {
  const Vectors before = state.positions;
  TissueChange change = turned(model.tissue, turns, 1, state.positions);
  state.velocities = with_new_nodes(model.tissue, change, state.velocities);
  follow_change(model, state, change, before);
  return change;
}

// Cells keep areas and normals of their faces while they change neighbours, though the anchors of a face are far apart
// then; a cell that leaves takes its area with it.
TEST(Foundation, ExchangesAndAnExtrusionLeaveAreasAndNormals) {
  constexpr std::size_t leaving = 24;
  Model model(tissue_from_prisms(honeycomb(7, 7, 3.5, 10), PolygonSplit::diagonals, 1));
  CellSet held(49, false);
  for (std::size_t c = 0; c < held.size(); c += 2) held[c] = true;
  model.laws.push_back(std::make_unique<Foundation>(model.tissue, held, basal_springs(Resists::normal)));
  for (std::size_t c = 0; c < held.size(); ++c) {
    CellSet one(held.size(), false);
    one[c] = true;
    model.laws.push_back(std::make_unique<Foundation>(model.tissue, one, basal_springs(Resists::normal)));
  }
  State state = rest_state(model);
  const auto lowered = [&] {
    Motion motion = at_rest(model.tissue);
    motion.positions = state.positions;
    for (Vec3& x : motion.positions) x.z() -= 2;
    motion.previous_positions = motion.positions;
    return motion;
  };
  const auto forces = [&] { return forces_of(*model.laws[0], lowered().step()); };
  const std::vector<double> areas = face_areas(model.tissue, CellSide::basal, model.tissue.rest_positions);
  const double whole = resultant(forces()).z();
  const auto expect_unchanged = [&](double part) {
    EXPECT_LE((resultant(forces()) - Vec3(0, 0, part * whole)).norm(), 1e-9 * whole);
  };
  Random random(3);
  std::size_t turns = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<WallTurn> chosen = random_turns(model.tissue, 8, random);
    turn(model, state, chosen);
    turns += chosen.size();
    smooth(model.tissue, state.positions);
    expect_unchanged(1);
  }
  EXPECT_GT(turns, 60U);
  for (std::size_t c = 0; c < areas.size(); ++c)  // k A u^2/2, however its faces share A
    EXPECT_NEAR(model.laws[1 + c]->energy(lowered().step()), 2 * winkler * areas[c], 1e-9 * areas[c]);
  while (model.tissue.cells[leaving].sides() > 3) {
    std::vector<WallTurn> possible = possible_turns(model.tissue.sheet);
    std::erase_if(possible,
                  [](const WallTurn& one) { return one.left != CellId(leaving) && one.right != CellId(leaving); });
    ASSERT_FALSE(possible.empty());
    possible.resize(1);
    turn(model, state, possible);
    ASSERT_EQ(possible.size(), 1U);
  }
  ASSERT_TRUE(extrude_cells(model, state, {CellId(leaving)}));
  expect_unchanged(24.0 / 25);
  const std::unique_ptr<Law> again = model.laws[0]->restored(model.tissue, no_change(model.tissue),
                                                             model.tissue.rest_positions, model.laws[0]->past());
  const Motion motion = random_motion(model.tissue, 3, 6);
  EXPECT_EQ(forces_of(*again, motion.step()), forces_of(*model.laws[0], motion.step()));
}

// Force on free nodes at these places, of a law for a tissue.
Vectors forces_at(const Law& law, const Tissue& tissue, std::span<const Vec3> free) {
  Motion motion = at_rest(tissue);
  std::ranges::copy(free, motion.positions.begin());
  tissue.place_hanging_positions(motion.positions);
  Vectors forces = forces_of(law, motion.step());
  tissue.carry_hanging(forces);
  forces.resize(free.size());
  return forces;
}

// On a curved sheet with nodes that hang: nodes of none but cells that an exchange leaves as they are.
TEST(Foundation, AnExchangeLeavesFarCellsTheirBits) {
  const auto on_tube = [](const Vec3& x) {
    const double angle = x.y() / 30;
    return Vec3(x.x(), (30 + x.z()) * std::sin(angle), (30 + x.z()) * std::cos(angle));
  };
  const PrismSheet tube = bent(irregular_polygons(8, 8, 3.5, 10, 0.15, 3), on_tube);
  Model model(tissue_from_prisms(tube, PolygonSplit::diagonals, 1));
  const Tissue& tissue = model.tissue;
  model.laws.push_back(
      std::make_unique<Foundation>(tissue, CellSet(tissue.cells.size(), true), basal_springs(Resists::normal, 0.1)));
  State state = rest_state(model);
  divide_cells(model, state, std::vector<PlannedDivision>{{.cut = {CellId(9), 0, 2}}, {.cut = {CellId(50), 1, 3}}});
  ASSERT_FALSE(tissue.hanging.empty());
  Random random(5);
  int exchanges = 0;
  for (int round = 0; round < 10; ++round) {
    const Tissue tissue_before = tissue;
    const std::unique_ptr<Law> law_before = model.laws[0]->clone();
    std::vector<WallTurn> turns = random_turns(tissue, 1, random);
    const TissueChange change = turn(model, state, turns);
    exchanges += static_cast<int>(turns.size());
    Vectors places(tissue.rest_positions.begin(),
                   tissue.rest_positions.begin() + static_cast<std::ptrdiff_t>(tissue.free_node_count()));
    for (Vec3& x : places) x += random.vector(2);
    const Vectors was = forces_at(*law_before, tissue_before, places), is = forces_at(*model.laws[0], tissue, places);
    std::vector<char> is_near(tissue.node_count(), 0);
    for (std::size_t e = 0; e < tissue.elements.size(); ++e)
      if (change.is_remeshed(tissue.element_cell[e]))
        for (const NodeId node : tissue.elements[e]) is_near[node.index()] = 1;
    int far = 0, changed = 0;
    for (std::size_t n = 0; n < places.size(); ++n)
      if (is_near[n] == 0) ++far, changed += was[n] != is[n] ? 1 : 0;
    EXPECT_GT(far, 100);
    EXPECT_EQ(changed, 0) << "of " << far << " nodes, round " << round;
    EXPECT_EQ(was == is, turns.empty());
  }
  EXPECT_GE(exchanges, 5);
}

const std::string pressed = block_table(60, 40, 20, "3, 2, 1") + R"([elasticity]
poisson_ratio = 0.3
[foundation.ground]
region = "all"
stiffness_nN_per_um3 = 0.02
drag_Pa_s_per_um = 50
resists = "normal"
[pressure.weight]
region = "all"
pressure_Pa = 100
[hold.x]
region = "all"
directions = ["x"]
x_um = [-31, -29]
[hold.y]
region = "all"
directions = ["y"]
y_um = [-21, -19]
[time]
end_s = 900
[stop]
equilibrium_speed_um_per_min = 1e-6
[monitor.base]
quantity = "position"
face = "basal"
axis = "z"
)";

// A pressure of 0.1 kPa on a modulus of 0.02 kPa/um: the base sinks evenly by 5 um.
TEST(Foundation, ABlockUnderPressureSinksByPressureOverModulus) {
  Simulation simulation(scenario_of(pressed));
  const double from = *simulation.measures().monitors.at(0);
  ASSERT_EQ(simulation.run(), RunStatus::equilibrium) << simulation.failure();
  EXPECT_NEAR(*simulation.measures().monitors.at(0) - from, -5, 1e-6);
  double lowest = 0, highest = -100;
  const Tissue& tissue = simulation.model().tissue;
  for (const Facet& facet : tissue.basal_facets)
    for (const NodeId node : facet.nodes) {
      const double z = simulation.state().positions[node.index()].z();
      lowest = std::min(lowest, z), highest = std::max(highest, z);
    }
  EXPECT_LE(highest - lowest, 1e-5);
}

// Through a division, a program's jump, and on other threads.
TEST(Foundation, RunsResumeBitwiseOnAnyNumberOfThreads) {
  const Scenario scenario =
      scenario_of(pressed, {"time.end_s=20", "foundation.ground.resists=one-sided",
                            "foundation.ground.program={time_s=[0,9,9],activity=[1,1,0.3]}", "division.d.region=all",
                            "division.d.at_s=4", "division.d.growth_s=8"});
  Simulation whole(scenario);
  std::vector<RunMemory> memories;
  while (whole.step()) memories.push_back(whole.memory());
  ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  EXPECT_EQ(whole.model().tissue.cells.size(), 12U);
  expect_to_end_alike(scenario, whole, memories, 0, 5);
}

TEST(FoundationKeys, ErrorsNameTheRemedy) {
  const std::string table = "[foundation.a]\nregion = \"all\"\n";
  const WrongScenarios cases = {
      {table, "1: foundation.a: has no effect; set stiffness_nN_per_um3 or drag_Pa_s_per_um"},
      {table + "drag_Pa_s_per_um = 1\nprogram = { time_s = [0, 1], activity = [0, 1] }",
       "4: foundation.a.program: is not used without stiffness_nN_per_um3; remove it, or set stiffness_nN_per_um3"},
      {table + "drag_Pa_s_per_um = 1\nresists = \"one-sided\"",
       "4: foundation.a.resists: \"one-sided\" is not used without stiffness_nN_per_um3; set resists to \"all\" or "
       "\"normal\", or set stiffness_nN_per_um3"},
      {table + "stiffness_nN_per_um3 = 1\nresists = \"sliding\"",
       "4: foundation.a.resists: \"sliding\" is unknown; set resists to one of: all | normal | one-sided"},
      {table + "stiffness_nN_per_um3 = -1",
       "3: foundation.a.stiffness_nN_per_um3: -1 is out of range; set stiffness_nN_per_um3 to a number >= 0"},
      {table + "stiffness_nN_per_um3 = 1\nfaces = \"lateral\"",
       "4: foundation.a.faces: \"lateral\" is unknown; set faces to one of: apical | basal"},
  };
  expect_errors(cases, load_errors);
  EXPECT_EQ(model_errors("[embryo]\nshape = \"block\"\ncells = [2, 2, 2]\n[region.top]\nz_um = [0, 99]\n"
                         "[foundation.a]\nregion = \"top\"\nstiffness_nN_per_um3 = 1"),
            "test.toml:7: foundation.a.region: no cell of this region has a basal face; set region to cells with this "
            "face, or change faces");
}

}  // namespace
