// What is around a tissue: drag, inertia, the vitelline membrane and its drag.
#include "mechanics/surroundings.hpp"

#include "mechanics/obstacles/shell_drag.hpp"
#include "mechanics/obstacles/vitelline.hpp"
#include "support/law_checks.hpp"

namespace plica {
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
  check_derivatives(FacePressure(tissue, true, CellSet{true, false}, 0.5, {}), tissue, 4);
}

TEST(FacePressure, PushesIntoTheCellsWithPressureTimesArea) {
  const Tissue tissue = build_block(two_cells);
  const Motion rest = at_rest(tissue);
  const FacePressure above(tissue, true, CellSet{true, true}, 0.5, {});
  const FacePressure below(tissue, false, CellSet{true, true}, 0.5, {});
  EXPECT_LE((resultant(forces_of(above, rest.step())) - Vec3(0, 0, -400)).norm(), 1e-11);
  EXPECT_LE((resultant(forces_of(below, rest.step())) - Vec3(0, 0, 400)).norm(), 1e-11);
}

TEST(FacePressure, ActsOnChosenCellsAndFollowsItsProgram) {
  const Tissue tissue = build_block(two_cells);
  const FacePressure law(tissue, true, CellSet{true, false}, 0.5, Program({0, 2}, {0, 1}));
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
  const FacePressure law(warped, false, CellSet(warped.cells.size(), true), 0.01, {});
  const Vectors forces = forces_of(law, at_rest(warped).step());
  EXPECT_LE(resultant(forces).norm(), 1e-11 * largest(forces));
  EXPECT_LE(torque(forces, positions).norm(), 1e-9 * largest(forces));
}

const Capsule pill{90, 140};
const Capsule ball{0, 140};

Vitelline shell_of(const Capsule& capsule) {
  return {build_block({.cells = {1, 1, 1}}), capsule};  // the gap does not depend on the tissue
}

TEST(Vitelline, GapIsTheDistanceToTheShell) {
  const Vitelline shell = shell_of(pill);
  struct Case {
    Vec3 position;
    double gap;
    Vec3 inward;
  };
  const std::vector<Case> cases = {{{0, 0, -140}, 0, {0, 0, 1}},           {{50, 0, -130}, 10, {0, 0, 1}},
                                   {{-70, 150, 0}, -10, {0, -1, 0}},       {{230, 0, 0}, 0, {-1, 0, 0}},
                                   {{-240, 0, 0}, -10, {1, 0, 0}},         {{90 + 60, 0, 80}, 40, {-0.6, 0, -0.8}},
                                   {{-90 - 84, 112, 0}, 0, {0.6, -0.8, 0}}};
  for (const Case& c : cases) {
    const Vitelline::Gap gap = shell.gap(c.position);
    EXPECT_NEAR(gap.value, c.gap, 1e-12);
    EXPECT_LE((gap.inward - c.inward).norm(), 1e-14);
  }
  RecordProperty("cases", static_cast<int>(cases.size()));
}

TEST(Vitelline, GradientAndHessianAgreeWithFiniteDifferences) {
  Random random(1);
  int cases = 0;
  for (const Capsule& capsule : {pill, ball}) {
    const Vitelline shell = shell_of(capsule);
    for (int k = 0; k < 50; ++k) {
      const Vec3 x = Vec3(random.number(120 + capsule.half_axis_um), random.number(120), 30 + random.number(20));
      // The Hessian jumps where the cylinder meets the caps.
      if (std::abs(std::abs(x.x()) - capsule.half_axis_um) < 1) continue;
      const Vitelline::Gap gap = shell.gap(x);
      EXPECT_NEAR(gap.inward.norm(), 1, 1e-14);
      const double d = 1e-4;
      for (int axis = 0; axis < 3; ++axis) {
        const Vitelline::Gap above = shell.gap(x + d * Vec3::Unit(axis)), below = shell.gap(x - d * Vec3::Unit(axis));
        EXPECT_NEAR(gap.inward[axis], (above.value - below.value) / (2 * d), 1e-8);
        EXPECT_LE((gap.hessian.col(axis) - (above.inward - below.inward) / (2 * d)).norm(), 1e-8);
      }
      ++cases;
    }
  }
  EXPECT_GT(cases, 80);
  RecordProperty("cases", cases);
}

TEST(Vitelline, HoldsEveryApicalNodeOnceAndNoOther) {
  const Tissue tissue = build_shell({});
  const Vitelline shell(tissue, *tissue.outer_shape);
  EXPECT_EQ(shell.nodes().size(), 758u);  // 756 facets on a closed surface
  for (std::size_t k = 0; k < shell.nodes().size(); ++k) {
    if (k > 0) {
      EXPECT_LT(shell.nodes()[k - 1], shell.nodes()[k]);
    }
    EXPECT_NEAR(shell.gap(tissue.rest_positions[shell.nodes()[k].index()]).value, 0, 1e-11);
  }
}

TEST(Vitelline, CentreHasAFiniteGap) {
  const Vitelline::Gap gap = shell_of(ball).gap(Vec3::Zero());
  EXPECT_EQ(gap.value, 140);
  EXPECT_TRUE(gap.inward.allFinite());
}

// Three cases: the capsule of a pill and of a sphere are found again; one node far out on the axis makes it longer, not
// wider.
TEST(EnclosingCapsule, IsTheOneThatABuiltEmbryoLiesOn) {
  for (const double length_um : {460.0, 280.0}) {
    const Tissue tissue = build_shell({.length_um = length_um});
    const Capsule capsule = enclosing_capsule(tissue.rest_positions);
    EXPECT_NEAR(capsule.radius_um, 140, 0.5) << "no node need lie on the widest circle";
    EXPECT_NEAR(capsule.half_axis_um + capsule.radius_um, length_um / 2, 0.5);
    const Vitelline shell(tissue, capsule);
    for (const NodeId node : shell.nodes())
      EXPECT_GE(shell.gap(tissue.rest_positions[node.index()]).value, -1e-12 * length_um);
  }
  const Capsule longer = enclosing_capsule({Vec3(0, 3, 4), Vec3(20, 0, 0)});
  EXPECT_DOUBLE_EQ(longer.radius_um, 5);
  EXPECT_DOUBLE_EQ(longer.half_axis_um, 15);
}

// The apical face of a block, 100 um from the axis, and a shell this far from it.
Tissue block() {
  Tissue tissue = build_block({.length_um = 40, .width_um = 20, .cell_height_um = 10, .cells = {4, 2, 1}});
  Vectors positions = tissue.rest_positions;
  double top = 0;
  for (const Facet& facet : tissue.apical_facets) top = positions[facet.nodes[0].index()].z();
  for (Vec3& x : positions) {
    const double radius = 100 + x.z() - top, angle = x.y() / 100;
    x = {x.x(), radius * std::sin(angle), radius * std::cos(angle)};
  }
  return with_rest_positions(std::move(tissue), std::move(positions));
}

ShellDrag drag_at(const Tissue& tissue, double gap) { return {tissue, Capsule{50, 100 + gap}, 0.3}; }

TEST(ShellDrag, DerivativesAgreeWithFiniteDifferences) {
  check_derivatives(drag_at(block(), 60), block(), 1);  // nodes move about: some are inside, some outside
  check_semidefinite_tangent(drag_at(block(), 60), block(), 1, false);
}

TEST(ShellDrag, SlowsWhatSlidesAlongTheShellAndTouchesIt) {
  const Tissue tissue = block();
  double area = 0;
  for (const Facet& facet : tissue.apical_facets) area += facet_area(rest_corners(tissue, facet));
  const auto slid = [&](double gap, const Vec3& by) {
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x += by;
    return forces_of(drag_at(tissue, gap), motion.step());
  };
  // All of it on the shell, half at half of the film, none beyond.
  for (const auto& [gap, part] : {std::pair(0.0, 1.0), {0.05, 0.5}, {0.11, 0.0}, {-0.01, 1.0}}) {
    const Vec3 force = resultant(slid(gap, {0.7, 0, 0}));  // in 0.7 s
    EXPECT_NEAR(force.x(), -part * 0.3 * area, 1e-9 * area);
    EXPECT_NEAR(force.tail<2>().norm(), 0, 1e-9);
  }
  // Only of apical nodes, and none against leaving.
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3 radial = Vec3(0, tissue.rest_positions[n].y(), tissue.rest_positions[n].z()).normalized();
    Motion motion = at_rest(tissue);
    motion.positions[n] -= 3 * radial;
    EXPECT_LE(largest(forces_of(drag_at(tissue, 0), motion.step())), 1e-9);
  }
}

}  // namespace
}  // namespace plica
