// A body that is turned as a whole feels nothing, whatever the angle and the axis.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

/// Largest nodal force over E A (A: mean face of a cell) after turns by 0 to 360 degrees about an axis.
double worst_force(const Tissue& tissue, const Vec3& axis, int& cases) {
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.45);
  const Corotational elasticity(tissue, moduli, 0);
  const Dilatation dilatation(tissue, moduli.bulk_modulus());
  const double area = 20 * 20;
  double worst = 0;
  for (int degrees = 0; degrees <= 360; degrees += 15) {
    const Mat3 R = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x = R * x + Vec3(30, -70, 11);
    motion.previous_positions = motion.positions;
    Vectors forces = forces_of(elasticity, motion.step());
    dilatation.add_forces(motion.step(), forces);
    worst = std::max(worst, largest(forces) / area);
    ++cases;
  }
  return worst;
}

TEST(RigidRotation, TurnedBlockHasNoForceAtAnyAngle) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 1}}, 2, 1);
  Random random(2);
  std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3(1, 1, 0), Vec3(1, -1, 1)};
  for (int k = 0; k < 40; ++k) axes.push_back(random.vector());
  double worst = 0;
  int cases = 0;
  for (const Vec3& axis : axes) worst = std::max(worst, worst_force(tissue, axis, cases));
  std::printf("rigid rotation of a block: largest force %.1e E A in %d turns\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

TEST(RigidRotation, TurnedPillHasNoForceAtAnyAngle) {
  const Tissue tissue = build_shell({});
  double worst = 0;
  int cases = 0;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 2, -3)})
    worst = std::max(worst, worst_force(tissue, axis, cases));
  std::printf("rigid rotation of the pill: largest force %.1e E A in %d turns\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

}  // namespace
}  // namespace plica
