// Extracellular matrix bonded to faces: derivatives, closed forms of a stretched, an inflated and a contracting
// membrane, relaxation, and what changes of the tissue leave.
#include "mechanics/matrix.hpp"

#include "mechanics/energy.hpp"
#include "mechanics/exchange.hpp"
#include "support/divided.hpp"
#include "support/law_checks.hpp"
#include "support/prisms.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"

namespace {

constexpr double mu_h = 0.6;  // nN/um

MatrixRule layer(double prestretch = 1, double relaxation_s = 0, Program program = {}) {
  return {CellSide::basal, mu_h, prestretch, relaxation_s, std::move(program)};
}

MatrixLayer layer_on(const Tissue& tissue, MatrixRule rule) {
  return {tissue, CellSet(tissue.cells.size(), true), std::move(rule)};
}

TEST(Matrix, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  for (const double relaxation_s : {0.0, 2.0}) {
    check_derivatives(layer_on(tissue, layer(1.2, relaxation_s, Program({0, 2}, {0.2, 1}))), tissue, 3);
    check_semidefinite_tangent(layer_on(tissue, layer(1, relaxation_s)), tissue, 3, true);
  }
  const MatrixLayer one(tissue, CellSet{false, true}, {CellSide::apical, mu_h});
  check_derivatives(one, tissue, 3);
}

TEST(Matrix, DerivativesOfARunAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  for (const double relaxation_s : {0.0, 2.0}) {
    const MatrixLayer law = layer_on(tissue, layer(1.2, relaxation_s, Program({0, 2}, {0.2, 1})));
    Motion motion = random_motion(tissue, 2, 9);
    motion.internal = law.first_internal(tissue);
    check_law_derivatives(law, tissue, 2, law.next_internal(motion.step()));
  }
}

TEST(Matrix, EnergyFlowIsTheWorkOfItsForces) {
  const Tissue tissue = distorted_block(two_cells, 2, 2);
  check_energy_flow(layer_on(tissue, layer(1.2)), tissue);
  check_energy_flow(layer_on(tissue, layer(1.2, 3)), tissue);
}

TEST(Matrix, AFallingProgramDissipatesWhatItReleases) {
  Model model(build_block(two_cells));
  model.laws.push_back(std::make_unique<MatrixLayer>(layer_on(model.tissue, layer(1.3, 0, Program({0, 2}, {1, 0})))));
  const State before = rest_state(model);
  State after = before;
  after.time_s = 2;
  const EnergyFlow flow = energy_flows(model, before, after).front();
  EXPECT_EQ(flow.active, 0);
  EXPECT_NEAR(flow.stored, -flow.dissipated, 1e-12);
  EXPECT_GT(flow.dissipated, 1);
}

TEST(Matrix, IsWithoutForceAtReferenceAndAfterARotation) {
  const Tissue tissue = distorted_block(two_cells, 2, 3);
  const MatrixLayer law = layer_on(tissue, layer());
  Random random(3);
  for (const Mat3& F : {Mat3(Mat3::Identity()), random.rotation()}) {
    Motion motion = deformed(tissue, F);
    motion.internal = law.first_internal(tissue);
    EXPECT_LE(largest(forces_of(law, motion.step())), 1e-12);
    EXPECT_NEAR(law.energy(motion.step()), 0, 1e-10);
  }
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Motion motion = random_motion(tissue, 3, seed);
    motion.internal = law.first_internal(tissue);
    const Vectors forces = forces_of(law, motion.step());
    EXPECT_LE(resultant(forces).norm(), 1e-11 * largest(forces));
    EXPECT_LE(torque(forces, motion.positions).norm(), 1e-9 * largest(forces));
  }
}

// Force on the end of the base, 20 um wide: mu h (a - 1/(p^6 a^3 b^2)) per reference width at stretches a, b.
TEST(Matrix, TensionIsThatOfAStretchedRubberSheet) {
  const Tissue tissue = build_block(two_cells);
  for (const double prestretch : {1.0, 1.25})
    for (const auto& [a, b] :
         std::vector<std::pair<double, double>>{{1.5, 1}, {1.4, 1.4}, {1.44, 1 / 1.2}, {0.8, 1.1}}) {
      const MatrixLayer law = layer_on(tissue, layer(prestretch));
      Motion motion = deformed(tissue, Vec3(a, b, 0.7).asDiagonal());
      motion.internal = law.first_internal(tissue);
      const Vectors forces = forces_of(law, motion.step());
      double end = 0;
      for (std::size_t n = 0; n < forces.size(); ++n)
        if (tissue.rest_positions[n].x() > 19) end += forces[n].x();
      EXPECT_NEAR(end, -20 * mu_h * (a - 1 / (std::pow(prestretch, 6) * a * a * a * b * b)), 1e-10);
    }
}

// Inner pressure of a neo-Hookean balloon: 2 mu h/R (1/s - 1/s^7), from the work of the forces on a growing volume.
TEST(Matrix, ABalloonHasThePressureOfItsStretch) {
  const Tissue tissue = build_shell({.length_um = 100, .diameter_um = 100, .cell_height_um = 10, .cells = {6, 6, 6}});
  const MatrixLayer law = layer_on(tissue, layer());
  double volume = 0, area = 0;
  for (const Facet& facet : tissue.basal_facets) {
    volume -= cone(facet.nodes, tissue.rest_positions);
    area += facet_area(gather(tissue.rest_positions, facet));
  }
  const double radius = 3 * volume / area;
  EXPECT_NEAR(radius, 40, 1.5);
  for (const double s : {1.1, 1.38, 2.0}) {
    Motion motion = deformed(tissue, Vec3::Constant(s).asDiagonal());
    motion.internal = law.first_internal(tissue);
    const Vectors forces = forces_of(law, motion.step());
    const double pressure = -dot(forces, motion.positions) / (3 * volume * s * s * s);
    EXPECT_NEAR(pressure, 2 * mu_h / radius * (1 / s - std::pow(s, -7)), 2e-4 * pressure);
  }
}

// At small strain a Maxwell element: held, the tension falls by 1/(1 + h/tau) in each step.
TEST(Matrix, TensionOfAHeldLayerDecays) {
  const Tissue tissue = build_block(two_cells);
  const MatrixLayer law = layer_on(tissue, layer(1, 10));
  Motion motion = deformed(tissue, Vec3(1.0001, 0.9998, 1).asDiagonal());
  motion.rate_s = 1e-9;
  motion.internal = law.first_internal(tissue);
  const double first = largest(forces_of(law, motion.step()));
  motion.rate_s = 2;
  for (int step = 1; step <= 10; ++step) {
    EXPECT_NEAR(largest(forces_of(law, motion.step())) / first, std::pow(1.2, -step), 1e-3);
    motion.internal = law.next_internal(motion.step());
  }
}

// The relaxed metric is that of the three-dimensional law with incompressible thickness.
TEST(Matrix, RelaxesAsIncompressibleNeoHookeanCellsDo) {
  MembranePoint::Mat2 B, C;
  B << 2, 0.3, 0.3, 1;
  C << 1.5, -0.4, -0.4, 3;
  const double r = 0.7;
  const auto whole = [](const MembranePoint::Mat2& metric) {
    Mat3 result = Mat3::Zero();
    result.topLeftCorner<2, 2>() = metric;
    result(2, 2) = 1 / metric.determinant();
    return result;
  };
  const Mat3 sum = whole(B) + r * whole(C), relaxed = sum / std::cbrt(sum.determinant());
  const MembranePoint point(B, C, 2, r);
  EXPECT_LE((point.rest() - relaxed.topLeftCorner<2, 2>()).norm(), 1e-14);
  // C S of an incompressible membrane without stress across: mu (C C_p^-1 - c/c_p).
  const MembranePoint::Mat2 stress = 2 * (point.rest().inverse() - whole(C)(2, 2) / relaxed(2, 2) * C.inverse());
  EXPECT_LE((point.stress() - stress).norm(), 1e-14);
  EXPECT_LE((point.relaxed().stress() - stress).norm(), 1e-14);
}

double energy_of(const Model& model, const State& state) {
  Step step = motionless(state, state.velocities);
  step.internal = state.internals.front();
  return model.laws.front()->energy(step);
}

// A stretched, partly relaxed layer, uniform in space.
State stretched_state(const Model& model) {
  State state = rest_state(model);
  for (Vec3& x : state.positions) x = Vec3(1.3 * x.x() + 0.2 * x.y(), 0.9 * x.y(), 1.1 * x.z());
  model.tissue.place_hanging_positions(state.positions);
  Step step = motionless(state, state.velocities);
  step.rate_s = 5;
  step.internal = state.internals.front();
  state.internals.front() = model.laws.front()->next_internal(step);
  return state;
}

TEST(Matrix, ADivisionLeavesItsElasticStrain) {
  for (const double relaxation_s : {0.0, 20.0}) {
    Model model(build_block({.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}}));
    model.laws.push_back(std::make_unique<MatrixLayer>(layer_on(model.tissue, layer(1.1, relaxation_s))));
    State state = stretched_state(model);
    const double before = energy_of(model, state);
    EXPECT_GT(before, 10);
    Random random(5);
    for (int round = 0; round < 3; ++round) divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
    EXPECT_GT(model.tissue.cells.size(), 20U);
    EXPECT_NEAR(energy_of(model, state), before, 1e-9 * before);
    EXPECT_TRUE(model.laws.front()->accepts(state.internals.front(), model.tissue));
  }
}

// Internal state of a layer under all cells, by cell.
std::vector<std::vector<double>> metrics_by_cell(const Model& model, const State& state) {
  const std::span<const double> numbers = state.internals[0];
  const std::size_t of_face = numbers.size() / model.tissue.basal_facets.size();
  std::vector<std::vector<double>> result(model.tissue.cells.size());
  for (std::size_t f = 0; f < model.tissue.basal_facets.size(); ++f) {
    const auto own = numbers.subspan(of_face * f, of_face);
    std::vector<double>& cell = result[model.tissue.basal_facets[f].cell.index()];
    cell.insert(cell.end(), own.begin(), own.end());
  }
  return result;
}

// Walls turn and a cell leaves in a flat sheet: neither the layer nor its energy changes, bitwise in cells that keep
// their faces.
TEST(Matrix, ExchangesAndAnExtrusionLeaveIt) {
  for (const double relaxation_s : {0.0, 20.0}) {
    Model model(tissue_from_prisms(honeycomb(7, 7, 3.5, 10), PolygonSplit::diagonals, 1));
    model.laws.push_back(std::make_unique<MatrixLayer>(layer_on(model.tissue, layer(1.1, relaxation_s))));
    State state = stretched_state(model);
    const double energy = energy_of(model, state);
    constexpr std::size_t cell = 24;
    for (int turn = 0; turn < 3; ++turn) {
      std::vector<WallTurn> turns = possible_turns(model.tissue.sheet);
      std::erase_if(turns, [&](const WallTurn& one) { return one.left != CellId(cell) && one.right != CellId(cell); });
      ASSERT_FALSE(turns.empty());
      turns.resize(1);
      const Vectors before = state.positions;
      const auto former = metrics_by_cell(model, state);
      const TissueChange change =
          turn_walls(model.tissue, turns, 1, state.positions, [](CellId) { return Mat3(Mat3::Identity()); });
      ASSERT_EQ(turns.size(), 1U);
      state.velocities = with_new_nodes(model.tissue, change, state.velocities);
      follow_change(model, state, change, before);
      EXPECT_NEAR(energy_of(model, state), energy, 1e-9 * energy) << turn;
      const auto present = metrics_by_cell(model, state);
      for (std::size_t c = 0; c < present.size(); ++c)
        EXPECT_EQ(present[c] == former[c], !change.is_remeshed(CellId(c))) << c;
    }
    ASSERT_TRUE(extrude_cells(model, state, {CellId(cell)}));
    EXPECT_NEAR(energy_of(model, state), energy, 1e-9 * energy);
  }
}

const std::string sandwich = block_table(60, 40, 10, "3, 2, 1") + R"([elasticity]
model = "neo-hookean"
young_modulus_Pa = 1000
poisson_ratio = 0.25
[matrix.below]
region = "all"
young_modulus_Pa = 30000
thickness_um = 0.1
prestretch = 1.3
[matrix.above]
region = "all"
faces = "apical"
young_modulus_Pa = 30000
thickness_um = 0.1
prestretch = 1.3
[time]
end_min = 300
[stop]
equilibrium_speed_um_per_min = 1e-6
[monitor.end]
quantity = "position"
axis = "x"
over = "max"
)";

// Incompressible cells, mu_c H = 4 nN/um, between layers of mu h = 1 nN/um: s^6 = (4 + 2 p^-6)/(4 + 2).
TEST(Matrix, ASheetBetweenPrestretchedLayersContractsByTheirModuli) {
  Simulation simulation(scenario_of(sandwich));
  ASSERT_EQ(simulation.run(), RunStatus::equilibrium) << simulation.failure();
  const double stretch = *simulation.measures().monitors.at(0) / 30;
  EXPECT_NEAR(stretch, std::pow((4 + 2 * std::pow(1.3, -6)) / 6, 1.0 / 6), 1e-6);
}

// Through a division, digestion, relaxation and growth, and on other threads.
TEST(Matrix, RunsResumeBitwiseOnAnyNumberOfThreads) {
  const Scenario scenario = scenario_of(
      sandwich, {"time.end_s=20", "stop.at_equilibrium=false", "matrix.below.relaxation_s=15",
                 "matrix.above.program={time_s=[0,9,9],activity=[1,1,0.1]}", "growth.g.region=all",
                 "growth.g.rate_per_h=40", "division.d.region=all", "division.d.at_s=4", "division.d.growth_s=8"});
  Simulation whole(scenario);
  std::vector<RunMemory> memories;
  while (whole.step()) memories.push_back(whole.memory());
  ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  EXPECT_EQ(whole.model().tissue.cells.size(), 12U);
  expect_to_end_alike(scenario, whole, memories, 0, 7);
}

TEST(MatrixKeys, ErrorsNameTheRemedy) {
  const std::string start = "[matrix.a]\nregion = \"all\"\n",
                    table = start + "young_modulus_Pa = 1\nthickness_um = 1\n";
  const WrongScenarios cases = {
      {start,
       "1: matrix.a.young_modulus_Pa: is missing; set young_modulus_Pa to a number > 0\n"
       "1: matrix.a.thickness_um: is missing; set thickness_um to a number > 0"},
      {start + "young_modulus_Pa = 0\nthickness_um = 1",
       "3: matrix.a.young_modulus_Pa: 0 is out of range; set young_modulus_Pa to a number > 0"},
      {start + "young_modulus_Pa = 1\nthickness_um = -1",
       "4: matrix.a.thickness_um: -1 is out of range; set thickness_um to a number > 0"},
      {table + "faces = \"lateral\"", "5: matrix.a.faces: \"lateral\" is unknown; set faces to one of: apical | basal"},
      {table + "prestretch = 0", "5: matrix.a.prestretch: 0 is out of range; set prestretch to a number > 0"},
      {table + "relaxation_min = 0",
       "5: matrix.a.relaxation_min: 0 is out of range; set relaxation_min to a number > 0 or \"none\""},
      {table + "relaxation_min = 1\nrelaxation_s = 60",
       "6: matrix.a.relaxation_s: conflicts with matrix.a.relaxation_min, which is also set; remove one of them"},
      {table + "program = { time_s = [0, 1], activity = [1] }",
       "5: matrix.a.program.activity: has length 1 for 2 times; set activity to as many values as times"},
      {table + "thicknes_um = 1", "5: matrix.a.thicknes_um: unknown key; use \"thickness_um\" (nearest match)"},
      {"[matrix.a]\nregion = \"tip\"\nyoung_modulus_Pa = 1\nthickness_um = 1",
       "2: matrix.a.region: region \"tip\" does not exist; use one of: all"},
  };
  expect_errors(cases, load_errors);
  EXPECT_EQ(model_errors("[embryo]\nshape = \"block\"\ncells = [2, 2, 2]\n[region.top]\nz_um = [0, 99]\n"
                         "[matrix.a]\nregion = \"top\"\nyoung_modulus_Pa = 1\nthickness_um = 1"),
            "test.toml:7: matrix.a.region: no cell of this region has a basal face; set region to cells with this "
            "face, or change faces");
}

}  // namespace
