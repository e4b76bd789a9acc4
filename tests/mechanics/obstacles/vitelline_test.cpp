#include "mechanics/obstacles/vitelline.hpp"

#include "support/tissues.hpp"

namespace {

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

}  // namespace
