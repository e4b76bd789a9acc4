// Division and growth of a model: what is continuous through a cut, and what daughters become.
#include "mechanics/division.hpp"

#include "mechanics/elasticity/corner_barrier.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "mechanics/elasticity/shape_memory.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/divided.hpp"
#include "support/elements.hpp"

namespace {

const BlockShape three_cells{.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}};
const BlockShape sheet{.length_um = 80, .width_um = 60, .cell_height_um = 40, .cells = {4, 3, 1}};

Vec3 momentum_of(const Model& model, const State& state) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < state.velocities.size(); ++n) sum += model.masses()[n] * state.velocities[n];
  return sum;
}

State moved(const Model& model, double size_um, Random& random) {
  State state = rest_state(model);
  for (Vec3& x : state.positions) x += random.vector(size_um);
  for (Vec3& v : state.velocities) v = random.vector(1);
  model.tissue.place_hanging(state.positions);
  model.tissue.place_hanging(state.velocities);
  return state;
}

TEST(DivideCells, KeepsLinearMomentum) {
  double worst = 0;
  int rounds = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Model model(distorted_block(sheet, 2, seed));
    add_elasticity(model);
    auto inertia = std::make_unique<Inertia>(model.tissue, 1e-12);
    model.laws.push_back(std::move(inertia));
    Random random(seed);
    State state = moved(model, 0.5, random);
    for (int round = 0; round < 3; ++round, ++rounds) {
      const Vec3 before = momentum_of(model, state);
      double size = 0;
      for (std::size_t n = 0; n < state.velocities.size(); ++n) size += model.masses()[n] * state.velocities[n].norm();
      divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
      worst = std::max(worst, (momentum_of(model, state) - before).norm() / size);
    }
  }
  EXPECT_LE(worst, 1e-14);
  std::cout << "linear momentum through " << rounds << " random rounds of cuts: off by " << worst << "\n";
}

TEST(DivideCells, KeepsTheTensionOfSprings) {
  double worst = 0;
  for (const auto& rule :
       {ContractionRule{.stiffness = 3, .across_ratio = 0.4, .rest_length_ratio = 0.5},
        ContractionRule{.stiffness = 3, .preload = 7, .damping = 2}, ContractionRule{.stiffness = 3, .diagonals = true},
        ContractionRule{.side = CellSide::lateral, .stiffness = 1},
        ContractionRule{.side = CellSide::basal, .stiffness = 1}}) {
    Model model(distorted_block(sheet, 2, 3));
    CellSet some(12, false);
    for (const int c : {1, 2, 5, 6, 7}) some[c] = true;
    auto law = std::make_unique<Contraction>(contraction_springs(model.tissue, some, rule), Program{});
    model.laws.push_back(std::move(law));
    Random random(4);
    State state = moved(model, 1, random);
    Vectors previous = state.positions;
    for (std::size_t n = 0; n < previous.size(); ++n) previous[n] -= 0.7 * state.velocities[n];
    for (int round = 0; round < 3; ++round) {
      const auto forces = [&] {
        Vectors result(state.positions.size(), Vec3::Zero());
        model.laws[0]->add_forces({state.positions, previous, state.velocities, 0.7, 1}, result);
        return result;
      };
      const Vectors before = forces();
      const TissueChange division = divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
      previous = with_new_nodes(model.tissue, division, previous);
      Vectors after = forces();
      for (std::size_t n = 0; n < after.size(); ++n) {
        const Vec3 expected = n < division.kept_nodes() ? before[n] : Vec3::Zero();
        worst = std::max(worst, (after[n] - expected).norm() / largest(before));
      }
    }
  }
  EXPECT_LE(worst, 1e-12);
  std::cout << "forces of contraction through random cuts: off by " << worst << "\n";
}

TEST(DivideCells, HandsPressuresHoldsAndContactsOn) {
  Model model = furrowing_sphere();
  model.held[3] = {true, false, true};
  State state = rest_state(model);
  for (std::size_t c = 0; c < state.multipliers.size(); ++c) state.multipliers[c] = static_cast<double>(c);
  const std::size_t contacts = state.on_obstacle.size();
  const TissueChange division = divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(40), 0}}});
  EXPECT_EQ(state.multipliers.at(450), 40);
  EXPECT_EQ(model.held[3], (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(model.held.size(), model.tissue.node_count());
  EXPECT_EQ(state.on_obstacle.size(), contacts + 2);
  EXPECT_EQ(model.obstacles.front()->nodes().size(), contacts + 2);
  for (std::size_t k = 0; k < state.on_obstacle.size(); ++k)
    EXPECT_EQ(state.on_obstacle[k] != 0, model.obstacles.front()->nodes()[k].index() < division.kept_nodes());
}

void grow(Model& model, double time_s) {
  if (std::optional<Model> later = grown(model, model, {}, time_s)) model = std::move(*later);
}

TEST(Grow, TakesDaughtersFromHalvesToTheirMothersShapeAndVolume) {
  Model model(distorted_block(three_cells, 2, 7));
  add_elasticity(model);
  State state = rest_state(model);
  state.time_s = 10;
  const HexPoints mother = hexahedron(model.tissue.cells[1].rest_shape);
  const double mothers_volume = model.volumes.targets()[1];
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 100, 1}});
  const auto sum = [&] { return model.volumes.targets()[1] + model.volumes.targets()[3]; };
  EXPECT_NEAR(sum(), mothers_volume, 1e-12 * mothers_volume);
  grow(model, 60);
  EXPECT_NEAR(sum(), 1.5 * mothers_volume, 1e-12 * mothers_volume);
  grow(model, 110);
  for (const int daughter : {1, 3}) {
    EXPECT_EQ(model.volumes.targets()[daughter], mothers_volume);
    for (int i = 0; i < 8; ++i) EXPECT_LE((model.tissue.cells[daughter].rest_shape[i] - mother[i]).norm(), 1e-13);
  }
  // Back again: a step may be taken anew.
  grow(model, 60);
  EXPECT_NEAR(sum(), 1.5 * mothers_volume, 1e-12 * mothers_volume);
}

TEST(Grow, OfADaughterThatDividesGoesTowardsTheSameSize) {
  Model model(build_block(three_cells));
  add_elasticity(model);
  State state = rest_state(model);
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 100, 1}});
  grow(model, 50);
  state.time_s = 50;
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 100, 1}});
  grow(model, 150);
  for (const int c : {1, 3, 4}) EXPECT_NEAR(model.volumes.targets()[c], 16000, 1e-9);
}

// Daughters that stay halves have nowhere to go: not a bit of their shapes changes, so no stiffness is made anew.
TEST(Grow, OfDaughtersThatStayHalvesChangesNothing) {
  Model model(distorted_block(three_cells, 2, 7));
  add_elasticity(model);
  State state = rest_state(model);
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 100, 0.5}});
  const auto shapes = model.tissue.element_rest_shape;
  int times = 0;
  for (double time_s = 0; time_s <= 120; time_s += 7, ++times) {
    grow(model, time_s);
    EXPECT_EQ(model.tissue.element_rest_shape, shapes) << time_s;
  }
  EXPECT_EQ(times, 18);
}

// An element's part of the volume that its cell is held at, whatever that of its rest shape is: otherwise the bulk
// modulus would press, and a daughter's pressure would show it.
TEST(Grow, BulkModulusIsAgainstTheVolumesThatCellsAreHeldAt) {
  Model model(distorted_block(three_cells, 2, 7));
  model.volumes.hold(true);
  model.laws.push_back(std::make_unique<Dilatation>(model.tissue, in_elements(model.tissue, 3.0), true));
  State state = rest_state(model);
  for (Vec3& x : state.positions) x = Vec3(1.3 * x.x(), 0.9 * x.y() + 0.002 * x.x() * x.z(), x.z());
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 1}, 100, 0.8}});
  ASSERT_GT(model.tissue.elements.size(), model.tissue.cells.size());
  int differ = 0;
  for (const double time_s : {0.0, 50.0, 100.0}) {
    grow(model, time_s);
    double expected = 0, by_rest_shapes = 0;
    for (std::size_t e = 0; e < model.tissue.elements.size(); ++e) {
      const std::size_t c = model.tissue.element_cell[e].index();
      const double rest = hex_volume(model.tissue.element_rest_shape[e]),
                   held = rest * model.volumes.targets()[c] / hex_volume(hexahedron(model.tissue.cells[c].rest_shape)),
                   now = hex_volume(gather(state.positions, model.tissue.elements[e]));
      expected += 3.0 / 2 * held * std::pow(now / held - 1, 2);
      by_rest_shapes += 3.0 / 2 * rest * std::pow(now / rest - 1, 2);
    }
    EXPECT_NEAR(model.laws[0]->energy(Step{state.positions, state.positions, state.velocities, 1, time_s}), expected,
                1e-9 * expected);
    differ += std::abs(by_rest_shapes - expected) > 1e-3 * expected;
  }
  EXPECT_GE(differ, 2);
}

// All laws of elements or of their faces: grown, they are those of the new rest shapes, bitwise, also at the end of a
// batch that is not full.
TEST(Grow, MakesLawsOfTheNewRestShapes) {
  const BlockShape row{.length_um = 220, .width_um = 20, .cell_height_um = 40, .cells = {11, 1, 1}};
  const auto laws_of = [](const Tissue& tissue) {
    std::vector<std::unique_ptr<Law>> laws;
    laws.push_back(std::make_unique<Corotational>(tissue, in_elements(tissue, ElasticModuli::from_young(1, 0.45)), 2));
    laws.push_back(
        std::make_unique<NeoHookean>(tissue, std::vector<NeoHookeanMaterial>(tissue.elements.size(), {0.4, 2})));
    laws.push_back(std::make_unique<ShapeMemory>(tissue, AttractorSprings{.shear_modulus = 0.3, .preload = 0.1}, 2));
    laws.push_back(std::make_unique<CornerBarrier>(tissue, 1, 0.9));
    laws.push_back(std::make_unique<Dilatation>(tissue, in_elements(tissue, 3.0), false));
    laws.push_back(std::make_unique<SurfaceDrag>(tissue, 1e-3));
    laws.push_back(std::make_unique<Inertia>(tissue, 1e-12));
    return laws;
  };
  Tissue tissue = distorted_block(row, 2, 5);
  const auto before = laws_of(tissue);
  const std::vector<ElementId> reshaped = {ElementId(2), ElementId(10)};
  for (const ElementId e : reshaped)
    for (Vec3& X : tissue.element_rest_shape[e.index()]) X *= 1.1;
  const auto anew = laws_of(tissue);
  Motion motion = random_motion(tissue, 2, 3);
  for (std::size_t l = 0; l < anew.size(); ++l) {
    SCOPED_TRACE(anew[l]->name());
    motion.internal = anew[l]->first_internal(tissue);
    const std::unique_ptr<Law> law = before[l]->grown(tissue, reshaped, {});
    EXPECT_EQ(forces_of(*law, motion.step()), forces_of(*anew[l], motion.step()));
    EXPECT_EQ(law->energy(motion.step()), anew[l]->energy(motion.step()));
    EXPECT_NE(forces_of(*before[l], motion.step()), forces_of(*anew[l], motion.step()));
  }
}

TEST(DivideCells, IsDoneWithWhoHasGrownUp) {
  Model model(build_block(sheet));
  add_elasticity(model);
  State state = rest_state(model);
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 0}, 100, 1}, {{CellId(6), 0}, 300, 1}});
  state.time_s = 200;
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(9), 0}, 100, 1}});
  std::vector<int> growing;
  for (const Growth& growth : model.growths) growing.push_back(growth.cell.number());
  EXPECT_EQ(growing, (std::vector<int>{6, 13, 9, 14}));  // and not 1 and 12
  grow(model, 400);
  for (const int c : {1, 12, 6, 13, 9, 14}) EXPECT_NEAR(model.volumes.targets()[c], 16000, 1e-9) << c;
}

// New nodes between held ones are held, those between a held and a free one are not; held ones make up for no momentum
// that the cut changes.
TEST(DivideCells, LeavesNewNodesThatAreHeldAtRest) {
  for (const double side : {-1.0, 1.0}) {
    Model model(distorted_block(sheet, 2, 3));
    auto inertia = std::make_unique<Inertia>(model.tissue, 1e-12);
    model.laws.push_back(std::move(inertia));
    Random random(3);
    State state = moved(model, 0.5, random);
    const auto lies_beyond = [&](std::size_t n, double x_um) {
      return side * model.tissue.rest_positions[n].x() > x_um;
    };
    for (std::size_t n = 0; n < state.velocities.size(); ++n)
      if (lies_beyond(n, -10)) {
        model.held[n] = {true, false, false};
        state.velocities[n].x() = 0;
      }
    const Vec3 before = momentum_of(model, state);
    std::vector<PlannedDivision> across;  // every cell: new nodes lie in the middle of the edges along x
    for (int c = 0; c < 12; ++c) across.push_back({{CellId(c), 0}, 0, 0.5});
    const TissueChange division = divide_cells(model, state, across);
    int held = 0, free = 0;
    for (std::size_t n = division.kept_nodes(); n < model.tissue.free_node_count(); ++n) {
      ++(model.held[n][0] ? held : free);
      EXPECT_EQ(model.held[n], (std::array<bool, 3>{lies_beyond(n, -5), false, false})) << n;
      EXPECT_TRUE(!model.held[n][0] || state.velocities[n].x() == 0) << n;
    }
    EXPECT_EQ(held, 2 * 8);
    EXPECT_EQ(free, 2 * 8);
    EXPECT_LE((momentum_of(model, state) - before).norm(), 1e-14 * before.norm());
  }
}

// A divided sheet under a homogeneous strain in its plane, with Poisson's ratio 0 so that no stress acts on the apical
// and basal faces: every node off the rim is in balance, what acts on hanging nodes carried by their neighbours.
TEST(DividedSheet, PassesThePatchTest) {
  Model model(build_block(sheet));
  add_elasticity(model, 0);
  State state = rest_state(model);
  Random random(11);
  for (int round = 0; round < 3; ++round) divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
  ASSERT_GT(model.tissue.hanging.size(), 20u);
  Mat3 strain = Mat3::Zero();
  strain.topLeftCorner<2, 2>() << 2e-6, 1e-6, 1e-6, -3e-6;
  Vectors positions = model.tissue.rest_positions;
  for (Vec3& x : positions) x += strain * x;
  const Motion motion{positions, positions, Vectors(positions.size(), Vec3::Zero())};
  Vectors forces(positions.size(), Vec3::Zero());
  for (const auto& law : model.laws) law->add_forces(motion.step(), forces);
  model.tissue.carry_hanging(forces);
  double inside = 0, rim = 0;
  int inner = 0;
  for (std::size_t n = 0; n < model.tissue.free_node_count(); ++n) {
    const Vec3& x = model.tissue.rest_positions[n];
    const bool on_rim = std::abs(x.x()) > 39.9 || std::abs(x.y()) > 29.9;
    (on_rim ? rim : inside) = std::max(on_rim ? rim : inside, forces[n].norm());
    inner += on_rim ? 0 : 1;
  }
  EXPECT_LE(inside, 1e-5 * rim);  // the corotational frame is exact to second order in the strain
  std::cout << inner << " inner nodes, " << model.tissue.hanging.size() << " hanging: force " << inside
            << " nN against " << rim << " on the rim\n";
}

// Newton's matrix on the free nodes is the laws' tangent seen through the hanging nodes.
TEST(DividedSheet, AssemblesTheTangentOfItsFreeNodes) {
  Model model(build_block(sheet));
  add_elasticity(model);
  add_drag(model);
  Random random(12);
  State state = moved(model, 0.5, random);
  for (int round = 0; round < 2; ++round) divide_cells(model, state, random_divisions(model.tissue, 0.5, random));
  const Motion motion{state.positions, state.positions, state.velocities};
  SystemMatrix matrix(model);
  matrix.set_zero();
  for (const auto& law : model.laws) law->add_tangent(motion.step(), matrix);
  Vectors direction = random.vectors(model.tissue.node_count());
  model.tissue.place_hanging(direction);
  const Vectors assembled = product_of(matrix, direction);
  Vectors matrix_free(direction.size(), Vec3::Zero());
  for (const auto& law : model.laws) law->add_tangent_product(motion.step(), direction, matrix_free);
  model.tissue.carry_hanging(matrix_free);
  for (std::size_t n = 0; n < direction.size(); ++n)
    EXPECT_LE((assembled[n] - matrix_free[n]).norm(), 1e-12 * largest(matrix_free));

  const auto volumes = [&](double part) {
    Vectors positions = state.positions;
    for (std::size_t n = 0; n < positions.size(); ++n) positions[n] += part * direction[n];
    return model.volumes.volumes(positions);
  };
  ConstraintJacobian jacobian(model);
  jacobian.update(model, state.positions);
  std::vector<double> rates(jacobian.sparse_rows());
  jacobian.rates(direction, rates);
  const std::vector<double> ahead = volumes(1e-4), behind = volumes(-1e-4);
  for (std::size_t c = 0; c < rates.size(); ++c) EXPECT_NEAR(rates[c], (ahead[c] - behind[c]) / 2e-4, 1e-5 * 2000);
}

}  // namespace
