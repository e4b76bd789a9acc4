#include "mechanics/surroundings.hpp"

#include "support/law_checks.hpp"

namespace {

TEST(SurfaceDrag, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 1);
  check_derivatives(SurfaceDrag(tissue, 0.14), tissue, 4);
}

// 40 x 20 um above and below, moving at 2 um/s: force d A v. Corners in the middle carry two quarters.
TEST(SurfaceDrag, UniformMotionMeetsDragTimesAreaTimesSpeed) {
  const Tissue tissue = build_block(two_cells);
  const double drag = 0.14, duration = 0.25;
  const Vec3 velocity(2, -1, 0.5);
  Motion motion = at_rest(tissue);
  motion.rate_s = duration;
  for (Vec3& x : motion.positions) x += duration * velocity;
  const Vectors forces = forces_of(SurfaceDrag(tissue, drag), motion.step());
  EXPECT_LE((resultant(forces) + drag * 1600 * velocity).norm(), 1e-11);
  for (std::size_t n = 0; n < forces.size(); ++n) {
    const double area = tissue.rest_positions[n].x() == 0 ? 200 : 100;
    EXPECT_LE((forces[n] + drag * area * velocity).norm(), 1e-11);
  }
}

TEST(SurfaceDrag, InnerNodesMoveFreely) {
  const Tissue tissue = build_block(
      {.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}, .elements_per_cell = {1, 1, 2}});
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x += Vec3(1, 0, 0);
  const Vectors forces = forces_of(SurfaceDrag(tissue, 1), motion.step());
  for (std::size_t n = 0; n < forces.size(); ++n)
    EXPECT_EQ(forces[n].norm() == 0, tissue.rest_positions[n].z() == 0) << "node " << n;
}

TEST(Inertia, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 2);
  check_derivatives(Inertia(tissue, 1e-4), tissue, 4);
}

TEST(Inertia, MassIsDensityTimesVolume) {
  const Tissue tissue = distorted_block(two_cells, 2, 3);
  double volume = 0, mass = 0;
  for (const HexPoints& shape : tissue.element_rest_shape) volume += hex_volume(shape);
  const Inertia law(tissue, 1e-4);
  for (const double m : law.masses()) mass += m;
  EXPECT_NEAR(mass, 1e-4 * volume, 1e-12 * volume);
}

TEST(Inertia, SteadyMotionNeedsNoForce) {
  const Tissue tissue = build_block(two_cells);
  Motion motion = at_rest(tissue);
  const Vec3 velocity(2, -1, 0.5);
  for (Vec3& x : motion.positions) x += motion.rate_s * velocity;
  motion.previous_velocities.assign(tissue.node_count(), velocity);
  EXPECT_LE(largest(forces_of(Inertia(tissue, 1), motion.step())), 1e-10);
}

// Newton: a force F on a mass m over h changes its velocity by F h / m.
TEST(Inertia, ForceIsMassTimesChangeOfVelocityOverTime) {
  const Tissue tissue = build_block(two_cells);
  const Inertia law(tissue, 1e-3);
  Motion motion = at_rest(tissue);
  Random random(1);
  motion.previous_velocities = random.vectors(tissue.node_count(), 3);
  const Vectors velocities = random.vectors(tissue.node_count(), 3);
  for (std::size_t n = 0; n < velocities.size(); ++n) motion.positions[n] += motion.rate_s * velocities[n];
  const Vectors forces = forces_of(law, motion.step());
  for (std::size_t n = 0; n < velocities.size(); ++n) {
    const double mass = 1e-3 * (tissue.rest_positions[n].x() == 0 ? 4000 : 2000);
    const Vec3 expected = -mass * (velocities[n] - motion.previous_velocities[n]) / motion.rate_s;
    EXPECT_LE((forces[n] - expected).norm(), 1e-11);
  }
}

TEST(FacePressure, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 4);
  check_derivatives(FacePressure(tissue, CellSide::apical, CellSet{true, false}, 0.5, {}), tissue, 4);
}

TEST(FacePressure, PushesIntoTheCellsWithPressureTimesArea) {
  const Tissue tissue = build_block(two_cells);
  const Motion rest = at_rest(tissue);
  const FacePressure above(tissue, CellSide::apical, CellSet{true, true}, 0.5, {});
  const FacePressure below(tissue, CellSide::basal, CellSet{true, true}, 0.5, {});
  EXPECT_LE((resultant(forces_of(above, rest.step())) - Vec3(0, 0, -400)).norm(), 1e-11);
  EXPECT_LE((resultant(forces_of(below, rest.step())) - Vec3(0, 0, 400)).norm(), 1e-11);
}

TEST(FacePressure, ActsOnChosenCellsAndFollowsItsProgram) {
  const Tissue tissue = build_block(two_cells);
  const FacePressure law(tissue, CellSide::apical, CellSet{true, false}, 0.5, Program({0, 2}, {0, 1}));
  Motion rest = at_rest(tissue);
  rest.end_time_s = 0.5;
  const Vectors forces = forces_of(law, rest.step());
  EXPECT_LE((resultant(forces) - Vec3(0, 0, -50)).norm(), 1e-12);
  for (std::size_t n = 0; n < forces.size(); ++n)
    if (tissue.rest_positions[n].x() > 0) {
      EXPECT_EQ(forces[n].norm(), 0);
    }
}

// A uniform pressure on a closed surface has no resultant and no torque, also on warped facets: the load is integrated
// exactly.
TEST(FacePressure, OnAClosedSurfaceHasNoResultantAndNoTorque) {
  const Tissue tissue = build_shell({.length_um = 280, .cells = {9, 9, 8}});
  Random random(2);
  Vectors positions = tissue.rest_positions;
  for (Vec3& x : positions) x += random.vector(2);
  const Tissue warped = with_rest_positions(tissue, positions);
  const FacePressure law(warped, CellSide::basal, CellSet(warped.cells.size(), true), 0.01, {});
  const Vectors forces = forces_of(law, at_rest(warped).step());
  EXPECT_LE(resultant(forces).norm(), 1e-11 * largest(forces));
  EXPECT_LE(torque(forces, positions).norm(), 1e-9 * largest(forces));
}

}  // namespace
