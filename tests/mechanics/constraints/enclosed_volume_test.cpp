#include "mechanics/constraints/enclosed_volume.hpp"

#include "measure/cells.hpp"
#include "support/constraint_law.hpp"
#include "support/divided.hpp"
#include "support/law_checks.hpp"
#include "tissue/shapes/polygon_embryo.hpp"

namespace {

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

}  // namespace
