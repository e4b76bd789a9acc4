#include "mechanics/constraints/cell_volume.hpp"

#include "support/constraint_law.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"

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
  check_derivatives(Dilatation(tissue, in_elements(tissue, 3.0), false), tissue, 4);
}

TEST(Dilatation, SemidefiniteTangentLeavesOutThePressure) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_semidefinite_tangent(Dilatation(tissue, in_elements(tissue, 3.0), false), tissue, 4, true);
}

TEST(Dilatation, RestAndRigidMotionsHaveNoForce) {
  const Tissue tissue = distorted_block(two_cells, 2, 6);
  const Dilatation law(tissue, in_elements(tissue, 3.0), false);
  EXPECT_LE(largest(forces_of(law, at_rest(tissue).step())), 1e-12);
  Random random(2);
  for (int k = 0; k < 10; ++k) EXPECT_LE(largest(forces_of(law, deformed(tissue, random.rotation()).step())), 1e-10);
}

// Cells that are held at another volume than their rest shapes': what their elements have of that is without force.
TEST(Dilatation, IsAgainstTheVolumeThatCellsAreHeldAt) {
  Tissue tissue = distorted_block({40, 20, 40, {2, 1, 1}, {2, 1, 2}}, 2, 6);
  const Dilatation at_own_volumes(tissue, in_elements(tissue, 3.0), true);
  for (Cell& cell : tissue.cells) cell.target_volume = 1.2 * cell_volume(tissue, cell, tissue.rest_positions);
  const std::unique_ptr<Law> law = at_own_volumes.grown(tissue, {}, {});
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
  const Dilatation law(tissue, in_elements(tissue, kappa), false);
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
  const Dilatation law(tissue, in_elements(tissue, kappa), false);
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions)
    if (x.x() == 0) x.x() = 1;  // of halves 10 um long: strains of 0.1 and -0.1
  EXPECT_NEAR(law.energy(motion.step()), 2 * kappa * 8000 * 0.01 / 2, 1e-9);
}

}  // namespace
