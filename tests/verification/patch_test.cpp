// The patch test of MacNeal and Harder (1985): seven distorted hexahedra in a unit cube, a linear displacement on the
// boundary. Inner nodes, stresses and the supports' forces must be exact.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/constraints/cell_volume.hpp"
#include "support/law_checks.hpp"
#include "support/linear_statics.hpp"

namespace plica {
namespace {

using namespace support;

const ElasticModuli moduli = ElasticModuli::from_young(1e6, 0.25);

/// With inner nodes drawn by `calm` towards those of a regular inner cube (1: all the way).
Tissue patch(double calm = 0) {
  Vectors nodes = {{0, 0, 0},          {1, 0, 0},          {1, 1, 0},          {0, 1, 0},
                   {0, 0, 1},          {1, 0, 1},          {1, 1, 1},          {0, 1, 1},
                   {.249, .342, .192}, {.826, .288, .288}, {.850, .649, .263}, {.273, .750, .230},
                   {.320, .186, .643}, {.677, .305, .683}, {.788, .693, .644}, {.165, .745, .702}};
  for (int i = 0; i < 8; ++i) nodes[8 + i] += calm * (0.25 * Vec3::Ones() + 0.5 * nodes[i] - nodes[8 + i]);
  return tissue_from_hexahedra({{8, 9, 10, 11, 12, 13, 14, 15},
                                {0, 1, 2, 3, 8, 9, 10, 11},
                                {12, 13, 14, 15, 4, 5, 6, 7},
                                {0, 1, 9, 8, 4, 5, 13, 12},
                                {1, 2, 10, 9, 5, 6, 14, 13},
                                {2, 3, 11, 10, 6, 7, 15, 14},
                                {3, 0, 8, 11, 7, 4, 12, 15}},
                               nodes);
}

/// u = 10^-3 (2x + y + z, x + 2y + z, x + y + 2z) / 2.
Mat3 gradient() { return 0.5e-3 * (Mat3::Ones() + Mat3::Identity()); }

// In this famous patch det J < 0 at a corner of the element towards y = 0, though it is positive at every Gauss point.
// plica refuses cells with such a corner, so the patch is assembled from the elements' stiffness.
TEST(Patch, HasSevenHexahedraOfVolumeOneOneOfThemWithAFoldedCorner) {
  const Tissue tissue = patch();
  double volume = 0;
  int folded = 0;
  for (const HexPoints& shape : tissue.element_rest_shape) {
    folded += hex_scaled_jacobian(shape) <= 0;
    for (const Vec3& corner : hex_reference_nodes)
      EXPECT_GT(hex_jacobian(shape, corner / std::sqrt(3.0)).determinant(), 0);
    volume += hex_volume(shape);
  }
  EXPECT_EQ(folded, 1);
  EXPECT_THROW(Corotational(tissue, moduli, 0), std::domain_error);
  EXPECT_EQ(tissue.elements.size(), 7u);
  EXPECT_NEAR(volume, 1, 1e-14);
}

void expect_linear_displacement_is_exact(const Tissue& tissue, LinearStatics statics, const char* name) {
  for (std::size_t n = 0; n < 8; ++n) statics.prescribe(n, gradient() * tissue.rest_positions[n]);
  const Vectors u = statics.solve();
  double worst_displacement = 0, worst_stress = 0, worst_force = 0;
  for (std::size_t n = 8; n < 16; ++n)
    worst_displacement = std::max(worst_displacement, (u[n] - gradient() * tissue.rest_positions[n]).norm() / 1e-3);

  int points = 0;
  const Mat3 exact = 400 * Mat3::Ones() + 1600 * Mat3::Identity();  // 2000 on the diagonal
  for (std::size_t e = 0; e < tissue.elements.size(); ++e)
    for (const Vec3& corner : hex_reference_nodes) {
      const Vec3 point = corner / std::sqrt(3.0);
      const Mat3 inverse = hex_jacobian(tissue.element_rest_shape[e], point).inverse();
      const auto shape = hex_shape_gradients(point);
      Mat3 H = Mat3::Zero();
      for (int i = 0; i < 8; ++i) H += u[tissue.elements[e][i].index()] * (inverse.transpose() * shape[i]).transpose();
      const Mat3 strain = 0.5 * (H + H.transpose());
      const Mat3 stress = moduli.lame_lambda * strain.trace() * Mat3::Identity() + 2 * moduli.shear_modulus * strain;
      worst_stress = std::max(worst_stress, (stress - exact).cwiseAbs().maxCoeff() / 2000);
      ++points;
    }

  // What the stiffness makes of it: the supports carry the exact stress, sigma n / 4 at each corner of a face.
  const Vectors reactions = statics.reactions(u);
  for (std::size_t n = 0; n < 8; ++n) {
    const Vec3 outward = 2 * tissue.rest_positions[n] - Vec3::Ones();
    worst_force = std::max(worst_force, (reactions[n] - exact * outward / 4).norm() / 2000);
  }
  std::printf("%s: relative errors of displacement %.1e, stress %.1e, supports' forces %.1e\n", name,
              worst_displacement, worst_stress, worst_force);
  EXPECT_LE(worst_displacement, 1e-10);
  EXPECT_LE(worst_stress, 1e-10);
  EXPECT_LE(worst_force, 1e-10);
  EXPECT_EQ(points, 56);
}

TEST(Patch, LinearDisplacementIsExactWithItsStress) {
  const Tissue tissue = patch();
  expect_linear_displacement_is_exact(tissue, LinearStatics::of_elements(tissue, moduli), "patch");
}

TEST(Patch, LinearDisplacementIsExactThroughTheLaws) {
  const Tissue tissue = patch(0.3);
  expect_linear_displacement_is_exact(tissue, {tissue, moduli}, "calmer patch, through the laws");
}

// The patch deformed and then turned by a finite rotation: the forces are those before, turned.
TEST(Patch, RotatedPatchHasRotatedForces) {
  const Tissue tissue = patch(0.3);
  const Corotational elasticity(tissue, moduli, 0);
  const Dilatation dilatation(tissue, moduli.bulk_modulus());
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x += 20 * (gradient() * x);
  Vectors before = forces_of(elasticity, motion.step());
  dilatation.add_forces(motion.step(), before);
  Random random(1);
  int cases = 0;
  double worst = 0;
  for (; cases < 50; ++cases) {
    const Mat3 R = random.rotation();
    Motion turned = motion;
    for (Vec3& x : turned.positions) x = R * x;
    Vectors after = forces_of(elasticity, turned.step());
    dilatation.add_forces(turned.step(), after);
    for (std::size_t n = 0; n < after.size(); ++n)
      worst = std::max(worst, (after[n] - R * before[n]).norm() / largest(before));
  }
  std::printf("rotated patch: relative error of forces %.1e in %d rotations\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

// Free faces carry nothing: at a uniform finite stretch the inner nodes of the patch are in balance.
TEST(Patch, InnerNodesBalanceAtAFiniteUniformStretch) {
  const Tissue tissue = patch(0.3);
  const Corotational elasticity(tissue, moduli, 0);
  const Dilatation dilatation(tissue, moduli.bulk_modulus());
  Motion motion = at_rest(tissue);
  const Mat3 F = Vec3(1.3, 0.9, 0.95).asDiagonal();
  for (Vec3& x : motion.positions) x = F * x;
  Vectors forces = forces_of(elasticity, motion.step());
  dilatation.add_forces(motion.step(), forces);
  for (std::size_t n = 8; n < 16; ++n) EXPECT_LE(forces[n].norm(), 1e-10 * largest(forces));
}

}  // namespace
}  // namespace plica
