// Constraints: volumes of cells, enclosed volumes, ties.
#include "mechanics/constraints/cell_volume.hpp"

#include "measure/cells.hpp"
#include "mechanics/constraints/enclosed_volume.hpp"
#include "mechanics/constraints/ties.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/constraint_law.hpp"
#include "support/divided.hpp"
#include "support/law_checks.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace plica {
namespace {

const BlockShape refined{
    .length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}, .elements_per_cell = {2, 1, 1}};

TEST(CellVolumes, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  const CellVolumes volumes(tissue);
  check_derivatives(ConstraintLaw(volumes, {0.7, -1.3}), tissue, 4);
}

TEST(CellVolumes, DerivativesAgreeWithFiniteDifferencesWithSeveralElementsACell) {
  const Tissue tissue = distorted_block(refined, 1, 2);
  const CellVolumes volumes(tissue);
  ASSERT_EQ(volumes.count(), 2u);
  check_derivatives(ConstraintLaw(volumes, {0.7, -1.3}), tissue, 2);
}

TEST(CellVolumes, RestAndRigidMotionsHaveNoError) {
  const Tissue tissue = distorted_block(refined, 1, 3);
  const CellVolumes volumes(tissue);
  Random random(1);
  for (int k = 0; k < 10; ++k) {
    const Mat3 R = random.rotation();
    const Vec3 shift = random.vector(100);
    Vectors positions = tissue.rest_positions;
    for (Vec3& x : positions) x = R * x + shift;
    for (const double error : volumes.relative_errors(positions)) EXPECT_NEAR(error, 0, 1e-12);
  }
}

TEST(CellVolumes, StretchedCellIsTooLargeByTheStretch) {
  const Tissue tissue = build_block(two_cells);
  const CellVolumes volumes(tissue);
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x.x() *= 1.1;
  for (const double error : volumes.relative_errors(positions)) EXPECT_NEAR(error, 0.1, 1e-13);
}

// Volume is homogeneous of degree 3: <x, grad V> = 3 V, not V as the paper has it.
TEST(CellVolumes, GradientTimesPositionsIsThreeVolumes) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  Vectors gradient(tissue.node_count(), Vec3::Zero());
  CellVolumes(tissue).add_forces(tissue.rest_positions, std::vector<double>{1, 1}, gradient);
  double product = 0;
  for (std::size_t n = 0; n < gradient.size(); ++n) product += gradient[n].dot(tissue.rest_positions[n]);
  const std::vector<double> volumes = CellVolumes(tissue).volumes(tissue.rest_positions);
  EXPECT_NEAR(product, 3 * (volumes[0] + volumes[1]), 1e-9 * product);
}

// A positive pressure pushes outward: on a face of area A with force p A.
TEST(CellVolumes, PositivePressurePushesFacesOutward) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}});
  const CellVolumes volumes(tissue);
  const std::vector<double> pressures = {0.25};
  Vectors forces(8, Vec3::Zero());
  volumes.add_forces(tissue.rest_positions, pressures, forces);
  double top = 0;
  for (std::size_t n = 0; n < 8; ++n)
    if (tissue.rest_positions[n].z() > 0) top += forces[n].z();
  EXPECT_NEAR(top, 0.25 * 400, 1e-12 * 100);
}

TEST(CellVolumes, PressuresHaveNoResultantAndNoTorque) {
  const Tissue tissue = distorted_block(refined, 1, 4);
  expect_no_resultant_and_no_torque(ConstraintLaw(CellVolumes(tissue), {0.7, -1.3}), tissue, 3);
}

TEST(Dilatation, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_derivatives(Dilatation(tissue, 3.0), tissue, 4);
}

TEST(Dilatation, SemidefiniteTangentLeavesOutThePressure) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_semidefinite_tangent(Dilatation(tissue, 3.0), tissue, 4, true);
}

TEST(Dilatation, RestAndRigidMotionsHaveNoForce) {
  const Tissue tissue = distorted_block(two_cells, 2, 6);
  const Dilatation law(tissue, 3.0);
  EXPECT_LE(largest(forces_of(law, at_rest(tissue).step())), 1e-12);
  Random random(2);
  for (int k = 0; k < 10; ++k) EXPECT_LE(largest(forces_of(law, deformed(tissue, random.rotation()).step())), 1e-10);
}

// Cells that are held at another volume than their rest shapes': what their elements have of that is without force.
TEST(Dilatation, IsAgainstTheVolumeThatCellsAreHeldAt) {
  Tissue tissue = distorted_block({40, 20, 40, {2, 1, 1}, {2, 1, 2}}, 2, 6);
  const Dilatation at_own_volumes(tissue, 3.0, true);
  for (Cell& cell : tissue.cells) cell.target_volume = 1.2 * cell_volume(tissue, cell, tissue.rest_positions);
  const std::unique_ptr<Law> law = at_own_volumes.grown(tissue, {});
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x *= std::cbrt(1.2);
  EXPECT_GT(largest(forces_of(at_own_volumes, motion.step())), 1);
  EXPECT_LE(largest(forces_of(*law, motion.step())), 1e-10);
  check_derivatives(*law, tissue, 4);
}

// Energy kappa V0 (V/V0 - 1)^2 / 2: a brick scaled by s on each side pushes back on a face of area A s^2 with kappa
// (s^3 - 1).
TEST(Dilatation, ScaledBrickHasThePressureOfItsBulkModulus) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}});
  const double kappa = 3, s = 1.05;
  const Dilatation law(tissue, kappa);
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x *= s;
  const double strain = s * s * s - 1;
  EXPECT_NEAR(law.energy(motion.step()), kappa * 16000 * strain * strain / 2, 1e-9);
  const Vectors forces = forces_of(law, motion.step());
  double top = 0;
  for (std::size_t n = 0; n < 8; ++n)
    if (tissue.rest_positions[n].z() > 0) top += forces[n].z();
  EXPECT_NEAR(top, -kappa * strain * 400 * s * s, 1e-9);
}

// Per element, not per cell: one element of a cell that grows at the other's cost is resisted.
TEST(Dilatation, ResistsOneElementGrowingAtAnothersCost) {
  const Tissue tissue = build_block(
      {.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}, .elements_per_cell = {2, 1, 1}});
  const double kappa = 3;
  const Dilatation law(tissue, kappa);
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions)
    if (x.x() == 0) x.x() = 1;  // of halves 10 um long: strains of 0.1 and -0.1
  EXPECT_NEAR(law.energy(motion.step()), 2 * kappa * 8000 * 0.01 / 2, 1e-9);
}

TEST(HeldVolume, IsTheLumen) {
  const Tissue tissue = build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}});
  const EnclosedVolume volume(tissue);
  EXPECT_NEAR(volume.targets()[0] / lumen_volume(tissue, tissue.rest_positions).value(), 1, 1e-14);
}

TEST(HeldVolume, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = build_block({.length_um = 40, .width_um = 20, .cells = {2, 1, 1}});
  check_derivatives(ConstraintLaw(EnclosedVolume(tissue), {0.7}), tissue, 4);
}

// Nodes that hang on its facets' edges, of polygons or after divisions, leave no hole.
TEST(HeldVolume, IsTheLumenWhereNodesHang) {
  Tissue divided = build_shell({200, 100, 20, {6, 4, 4}, {1, 1, 1}});
  Random random(3);
  for (int round = 0; round < 2; ++round) divide(divided, cuts_of(random_divisions(divided, 0.5, random)), 0);
  for (const Tissue& tissue : {divided, build_egg({250, 120, 120, 11, 5}, 300, 1, {20, PolygonSplit::diagonals, 1})}) {
    ASSERT_FALSE(tissue.hanging.empty());
    EXPECT_TRUE(EnclosedVolume::is_closed(tissue));
    Vectors moved = tissue.rest_positions;
    for (Vec3& x : moved) x += Vec3(0.1 * x.y(), 0.2 * x.x(), 30);
    const double lumen = lumen_volume(tissue, moved).value();
    EXPECT_NEAR(EnclosedVolume(tissue).volume(moved), lumen, 1e-12 * lumen);
  }
}

// A slice is closed by the planes at its ends: the prism over its basal polygon, wherever nodes go in these planes. A
// sheet with another rim encloses nothing.
TEST(HeldVolume, OfASliceIsClosedByItsPlanes) {
  const ShellShape shape{7, 180, 35, {2, 6, 4}, {1, 1, 1}};
  const Tissue tissue = build_slice(shape);
  const EnclosedVolume volume(tissue);
  EXPECT_TRUE(EnclosedVolume::is_closed(tissue));
  const double sectors = 20, radius = 55;
  EXPECT_NEAR(volume.targets()[0], 7 * sectors / 2 * radius * radius * std::sin(2 * M_PI / sectors), 1e-9 * 6e4);
  Vectors moved = tissue.rest_positions;
  for (Vec3& x : moved) x += Vec3(0, 30, 5);
  EXPECT_NEAR(volume.volume(moved) / volume.targets()[0], 1, 1e-12);
  for (Vec3& x : moved) x = Vec3(x.x(), 2 * x.y() + 0.3 * x.z(), 1.5 * x.z());
  EXPECT_NEAR(volume.volume(moved) / volume.targets()[0], 3, 1e-12);
  check_derivatives(ConstraintLaw(EnclosedVolume(tissue), {0.7}), tissue, 4);
  EXPECT_FALSE(EnclosedVolume::is_closed(build_block({.length_um = 40, .width_um = 20, .cells = {2, 1, 1}})));
  EXPECT_TRUE(EnclosedVolume::is_closed(build_shell({60, 60, 15, {2, 2, 2}, {1, 1, 1}})));
}

// A ball whose surface is moved outward by a small way: the pressure is K times the relative loss of volume.
TEST(ElasticVolume, PressureIsTheModulusTimesTheLoss) {
  const Tissue tissue = build_shell({100, 100, 20, {8, 8, 8}, {1, 1, 1}});
  const ElasticVolume law(tissue, 50);
  Vectors smaller = tissue.rest_positions;
  for (Vec3& x : smaller) x *= 0.99;
  EXPECT_NEAR(law.pressure(smaller), 50 * (1 - 0.99 * 0.99 * 0.99), 1e-9);
}

// Its matrix leaves out what joins every node with every other, so only the product has all of the tangent.
TEST(ElasticVolume, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = build_shell({60, 60, 15, {2, 2, 2}, {1, 1, 1}});
  const ElasticVolume law(tissue, 0.4);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    Motion motion = random_motion(tissue, 3, seed);
    expect_forces_are_minus_energy_gradient(law, motion, 1e-6);
    const Vectors direction = Random(seed).vectors(tissue.node_count());
    const Eigen::VectorXd product = product_of(law, motion.step(), direction);
    const auto forces_at = [&](double way) {
      Motion there = motion;
      for (std::size_t n = 0; n < direction.size(); ++n) there.positions[n] += way * direction[n];
      return flat(forces_of(law, there.step()));
    };
    const Eigen::VectorXd difference = -(forces_at(difference_um) - forces_at(-difference_um)) / (2 * difference_um);
    EXPECT_LE((product - difference).norm(), 1e-6 * difference.norm());
    motion.semidefinite_tangent = true;
    EXPECT_GE(flat(direction).dot(product_of(law, motion.step(), direction)), 0);
  }
}

TEST(Ties, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = build_slice({14, 180, 35, {2, 4, 4}, {1, 1, 1}});
  const std::vector<Ties::Tie> ties = ties_along_x(tissue);
  EXPECT_EQ(ties.size(), 2u * 2 * 16);  // of three planes, the second and the third
  check_derivatives(Ties(ties, 3), tissue, 4);
  check_semidefinite_tangent(Ties(ties, 3), tissue, 4, false);
}

// Two nodes, pushed apart by 12 nN: F/k further apart.
TEST(Ties, GiveWayByForceOverStiffness) {
  const Tissue tissue = build_block({.length_um = 20, .width_um = 20, .cell_height_um = 20, .cells = {1, 1, 1}});
  const NodeId a = tissue.elements[0][0], b = tissue.elements[0][6];
  const Ties law({{{a, b}, tissue.rest_positions[b.index()] - tissue.rest_positions[a.index()]}}, 400);
  Motion motion = at_rest(tissue);
  EXPECT_EQ(law.energy(motion.step()), 0);
  motion.positions[b.index()].y() += 12.0 / 400;
  EXPECT_NEAR(forces_of(law, motion.step())[a.index()].y(), 12, 1e-9);
  EXPECT_NEAR(resultant(forces_of(law, motion.step())).norm(), 0, 1e-12);
}

// The planes of a slice move alike, however uneven its cells are.
TEST(Ties, KeepASliceAsIfItWereEndless) {
  Simulation simulation(load_scenario(find_scenario("furrow-slice"), {"cortex.apical.variation.spread=0.3",
                                                                      "time.end_min=18", "output.cells_csv=false"}));
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  double apart = 0;
  for (const auto& [nodes, rest, share] : ties_along_x(simulation.model().tissue))
    apart = std::max(
        apart, (simulation.state().positions[nodes[1].index()] - simulation.state().positions[nodes[0].index()] - rest)
                   .norm());
  EXPECT_LT(apart, 0.02);
  EXPECT_GT(*simulation.measures()["furrow_depth_um"], 30);
  EXPECT_EQ(*simulation.measures()["self_intersections"], 0);
}

}  // namespace
}  // namespace plica
