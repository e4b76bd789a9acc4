// Distances to capsules and to smooth surfaces, against finite differences and each other.
#include "tissue/outer_shape.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "support/tissues.hpp"
#include "tissue/shapes/egg_surface.hpp"

namespace plica {
namespace {

using namespace support;

OuterShape egg(double length_um, double width_um) {
  return OuterShape(std::make_shared<const StarSurface>(egg_surface({length_um, width_um, width_um, {}, {}})));
}

void expect_derivatives(const OuterShape& shape, const Vec3& point) {
  const OuterShape::Gap gap = shape.gap(point);
  EXPECT_NEAR(gap.inward.norm(), 1, 1e-9);
  constexpr double step = 1e-3;
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 way = step * Vec3::Unit(axis);
    const OuterShape::Gap after = shape.gap(point + way), before = shape.gap(point - way);
    EXPECT_NEAR((after.value - before.value) / (2 * step), gap.inward[axis], 1e-6);
    EXPECT_LE(((after.inward - before.inward) / (2 * step) - gap.hessian.col(axis)).norm(), 1e-6);
  }
}

TEST(OuterShape, GapsHaveTheirDerivatives) {
  Random random(4);
  const OuterShape capsule(Capsule{60, 90}), surface = egg(500, 180).moved_out(0.5);
  for (int i = 0; i < 20; ++i) {
    const Vec3 way = random.vector().normalized();
    expect_derivatives(capsule, 100 * way);
    // On the egg, and some um to either side.
    const Vec3 on(250 * way.x(), 90 * way.y(), 90 * way.z());
    expect_derivatives(surface, (1 + random.number(0.01)) * on);
  }
}

TEST(OuterShape, OfAnEggThatIsABallIsTheBall) {
  const OuterShape ball(Capsule{0, 90}), surface = egg(180, 180);
  Random random(5);
  for (int i = 0; i < 20; ++i) {
    const Vec3 point = (85 + random.number(10)) * random.vector().normalized();
    EXPECT_NEAR(surface.gap(point).value, ball.gap(point).value, 1e-6);
    EXPECT_LE((surface.gap(point).hessian - ball.gap(point).hessian).norm(), 1e-6);
    Vec3 outward(random.number(), 0, random.number()), inside = random.vector(40);
    outward.normalize(), inside.y() = 0;
    EXPECT_NEAR(surface.depth(inside, outward), ball.depth(inside, outward), 1e-6);
  }
  EXPECT_NEAR(surface.volume() / ball.volume(), 1, 1e-4);
  EXPECT_NEAR(surface.moved_out(5).volume() / ball.moved_out(5).volume(), 1, 1e-4);
  EXPECT_NEAR(surface.moved_out(5).gap({80, 0, 0}).value, 15, 1e-6);
}

// Deep inside a gap is a lower bound or near it: nothing is kept there.
TEST(OuterShape, IsFarFromWhatLiesDeep) {
  const OuterShape surface = egg(500, 180);
  for (const Vec3& point : {Vec3(0, 0, 0), Vec3(10, 0, 20), Vec3(-150, 10, 30)}) EXPECT_GT(surface.gap(point).value, 5);
}

}  // namespace
}  // namespace plica
