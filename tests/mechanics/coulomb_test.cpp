#include "mechanics/coulomb.hpp"

#include "support/tissues.hpp"

namespace {

TEST(Coulomb, IsTheLimitWhereItSlidesAndSmoothWhereItDoesNot) {
  const Coulomb friction{3};
  EXPECT_EQ(friction.force(Vec3::Zero()).norm(), 0);
  Random random(2);
  for (const double part : {0.1, 0.7, 0.999, 1.001, 5.0, 1e4}) {
    const double speed = part * Coulomb::stick_speed;
    const Vec3 velocity = speed * random.vector().normalized(), force = friction.force(velocity);
    EXPECT_NEAR(force.norm(), part < 1 ? 3 * (2 * part - part * part) : 3, 1e-12);
    EXPECT_NEAR(force.dot(velocity), -force.norm() * speed, 1e-12);
    // Of a power, by its potential, and of a force.
    const double d = 1e-5 * Coulomb::stick_speed;
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 above = velocity + d * Vec3::Unit(axis), below = velocity - d * Vec3::Unit(axis);
      EXPECT_NEAR((friction.potential(above) - friction.potential(below)) / (2 * d), -force[axis], 1e-6);
      EXPECT_LE(
          (friction.resistance(velocity).col(axis) + (friction.force(above) - friction.force(below)) / (2 * d)).norm(),
          1e-4 * 3 / Coulomb::stick_speed);
    }
    EXPECT_GE(friction.resistance(velocity).selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9);
  }
}

}  // namespace
