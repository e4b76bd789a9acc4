#include "mechanics/elasticity/shape_memory.hpp"

#include "mechanics/elasticity/corotational.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"

namespace {

const BlockShape narrow_cell{.length_um = 20, .width_um = 16, .cell_height_um = 40, .cells = {1, 1, 1}};

TEST(ShapeMemory, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_derivatives(ShapeMemory(tissue, {.stiffness = 8}, 0), tissue, 4);
}

TEST(ShapeMemory, DerivativesAgreeWithFiniteDifferencesWithEverythingOn) {
  const Tissue tissue = distorted_block(two_cells, 2, 6);
  check_derivatives(ShapeMemory(tissue, {.shear_modulus = 0.3, .preload = 10, .preload_length = 0.5}, 2), tissue, 4);
}

TEST(ShapeMemory, RestAndRigidMotionsHaveNoForceAndNoEnergy) {
  const Tissue tissue = distorted_block(two_cells, 2, 7);
  const ShapeMemory law(tissue, {.stiffness = 8, .preload = 10, .preload_length = 0.5}, 1);
  Random random(3);
  for (int k = 0; k < 20; ++k) {
    const Motion motion = deformed(tissue, k == 0 ? Mat3(Mat3::Identity()) : random.rotation());
    EXPECT_LE(largest(forces_of(law, motion.step())), 1e-10);
    EXPECT_LE(law.energy(motion.step()), 1e-20);
  }
}

// The law as the paper writes it: each node is pulled along its spring to the attractor and nothing else acts. The
// attractor is placed here by another way, the singular value decomposition of sum x X^T (Kabsch 1976).
TEST(ShapeMemory, EachNodeIsPulledStraightToItsPlaceInTheAttractor) {
  const double k = 8;
  const Tissue tissue = distorted_block(narrow_cell, 2, 8);
  const ShapeMemory law(tissue, {.stiffness = k}, 0);
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Motion motion = random_motion(tissue, 4, seed);
    const HexPoints X = tissue.element_rest_shape[0], x = gather(motion.positions, tissue.elements[0]);
    Vec3 C = Vec3::Zero(), c = Vec3::Zero();
    for (int i = 0; i < 8; ++i) C += X[i] / 8, c += x[i] / 8;
    Mat3 A = Mat3::Zero();
    for (int i = 0; i < 8; ++i) A += (x[i] - c) * (X[i] - C).transpose();
    const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    const Mat3 R = svd.matrixU() * svd.matrixV().transpose();
    ASSERT_GT(R.determinant(), 0);
    const Vectors forces = forces_of(law, motion.step());
    for (int i = 0; i < 8; ++i) {
      const Vec3 spring = x[i] - (c + R * (X[i] - C));
      EXPECT_LE((forces[tissue.elements[0][i].index()] + k * spring).norm(), 1e-11 * largest(forces));
    }
  }
}

TEST(ShapeMemory, ForcesHaveNoResultantAndNoTorque) {
  const Tissue tissue = distorted_block(two_cells, 2, 9);
  for (const double preload : {0.0, 10.0})
    expect_no_resultant_and_no_torque(
        ShapeMemory(tissue, {.stiffness = 8, .preload = preload, .preload_length = 0.5}, 2), tissue, 4);
}

// A brick a x b x c: energy per volume under small strains against the moduli of the theory page, and these against
// what attractor_moduli says. A strain along one axis gives no force along the others.
TEST(ShapeMemory, BrickHasTheModuliOfTheTheory) {
  const double k = 8, a = 20, b = 16, c = 40, size = 1e-5;
  const Tissue tissue = build_block(narrow_cell);
  const ShapeMemory law(tissue, {.stiffness = k}, 0);
  const auto modulus = [&](const Mat3& strain) {
    return 2 * law.energy(deformed(tissue, Mat3::Identity() + size * strain).step()) / (size * size * a * b * c);
  };
  const auto entry = [](int i, int j) {
    Mat3 strain = Mat3::Zero();
    strain(i, j) = 1;
    return strain;
  };
  const double along_a = 2 * k * a / (b * c), along_b = 2 * k * b / (a * c), along_c = 2 * k * c / (a * b);
  EXPECT_NEAR(modulus(entry(0, 0)), along_a, 1e-4 * along_a);
  EXPECT_NEAR(modulus(entry(1, 1)), along_b, 1e-4 * along_b);
  EXPECT_NEAR(modulus(entry(2, 2)), along_c, 1e-4 * along_c);
  EXPECT_NEAR(modulus(Mat3::Identity()), along_a + along_b + along_c, 1e-4 * along_c);  // no coupling
  // A simple shear of either kind: the attractor turns along as it fits best.
  const double shear_ab = 2 * k * a * b / (c * (a * a + b * b)), shear_ac = 2 * k * a * c / (b * (a * a + c * c)),
               shear_bc = 2 * k * b * c / (a * (b * b + c * c));
  for (const auto& [i, j, shear] :
       {std::tuple{0, 1, shear_ab}, {1, 0, shear_ab}, {0, 2, shear_ac}, {2, 0, shear_ac}, {1, 2, shear_bc}}) {
    EXPECT_NEAR(modulus(entry(i, j)), shear, 1e-4 * shear);
  }
  // Principal axes in the order of their lengths: b, a, c.
  const AttractorModuli moduli = attractor_moduli(tissue.element_rest_shape[0], k);
  EXPECT_LE((moduli.uniaxial - Vec3(along_b, along_a, along_c)).norm(), 1e-12);
  EXPECT_LE((moduli.shear - Vec3(shear_ac, shear_bc, shear_ab)).norm(), 1e-12);
}

TEST(ShapeMemory, CubeIsIsotropicWithPoissonsRatioZero) {
  const double k = 8, side = 20;
  const Tissue cube = build_block({.length_um = side, .width_um = side, .cell_height_um = side, .cells = {1, 1, 1}});
  const AttractorModuli moduli = attractor_moduli(cube.element_rest_shape[0], k);
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(moduli.uniaxial[i], 2 * k / side, 1e-13);
    EXPECT_NEAR(moduli.shear[i], k / side, 1e-13);
  }
  EXPECT_NEAR(moduli.mean_shear(), k / side, 1e-13);
  // Turned and energies compared: no direction is special.
  const ShapeMemory law(cube, {.stiffness = k}, 0);
  Random random(1);
  const Mat3 strain = Vec3(1e-4, -2e-4, 3e-4).asDiagonal();
  const double expected = law.energy(deformed(cube, Mat3::Identity() + strain).step());
  for (int i = 0; i < 5; ++i) {
    const Mat3 Q = random.rotation();
    const double energy = law.energy(deformed(cube, Mat3::Identity() + Q * strain * Q.transpose()).step());
    EXPECT_NEAR(energy, expected, 1e-3 * expected);
  }
}

TEST(ShapeMemory, DerivedStiffnessGivesTheMeanShearModulus) {
  const Tissue tissue = distorted_block(two_cells, 2, 10);
  const ShapeMemory law(tissue, {.shear_modulus = 0.345}, 0);
  for (std::size_t e = 0; e < 2; ++e)
    EXPECT_NEAR(attractor_moduli(tissue.element_rest_shape[e], law.stiffness()[e]).mean_shear(), 0.345, 1e-14);
}

TEST(ShapeMemory, GivenStiffnessKeepsItsModuliInRefinedCells) {
  BlockShape shape = narrow_cell;
  const Tissue coarse = build_block(shape);
  shape.elements_per_cell = {2, 2, 2};
  const Tissue fine = build_block(shape);
  const AttractorSprings springs{.stiffness = 8, .preload = 4, .preload_length = 1e-9};
  const ShapeMemory one(coarse, springs, 0), eight(fine, springs, 0);
  const AttractorModuli expected = attractor_moduli(coarse.element_rest_shape[0], one.stiffness()[0]);
  for (std::size_t e = 0; e < 8; ++e) {
    const AttractorModuli found = attractor_moduli(fine.element_rest_shape[e], eight.stiffness()[e]);
    EXPECT_LE((found.uniaxial - expected.uniaxial).norm() + (found.shear - expected.shear).norm(), 1e-12);
  }
  // Stress through the end of a stretched body: the springs' and the preload's.
  Mat3 F = Mat3::Identity();
  F(0, 0) = 1.01;
  const auto pull = [&](const ShapeMemory& law, const Tissue& tissue) {
    const Vectors forces = forces_of(law, deformed(tissue, F).step());
    double sum = 0;
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (tissue.rest_positions[n].x() > 9) sum += forces[n].x();
    return sum;
  };
  EXPECT_NEAR(pull(one, coarse), -4 * (8 * 0.1 + 4), 1e-9);
  EXPECT_NEAR(pull(eight, fine), pull(one, coarse), 1e-9);
}

// A brick stretched along x: every node is off its place by the same, the tension is k d + P d / sqrt(d^2 + e^2).
TEST(ShapeMemory, PreloadIsATensionThatDoesNotGrowWithLength) {
  const double k = 8, P = 5, e = 0.5;
  const Tissue tissue = build_block(narrow_cell);
  const ShapeMemory law(tissue, {.stiffness = k, .preload = P, .preload_length = e}, 0);
  for (const double stretch : {1e-6, 0.01, 0.05, 0.5}) {
    Mat3 F = Mat3::Identity();
    F(0, 0) = 1 + stretch;
    const double d = 10 * stretch, tension = k * d + P * d / std::sqrt(d * d + e * e);
    const Vectors forces = forces_of(law, deformed(tissue, F).step());
    for (std::size_t n = 0; n < 8; ++n) {
      EXPECT_NEAR(std::abs(forces[n].x()), tension, 1e-9 * (k + P));
      EXPECT_NEAR(forces[n].y(), 0, 1e-12);
    }
  }
}

// Pure bending of one brick: the springs are at its corners, so it is three times as stiff as a homogeneous beam of the
// same uniaxial modulus: E I with I = b c^3 / 12 and E = 2 k a / (b c) would be a third of the energy.
TEST(ShapeMemory, BendsThreeTimesAsStiffAsABeamOfItsUniaxialModulus) {
  const double k = 8, a = 20, b = 16, c = 40, curvature = 1e-7;
  const Tissue tissue = build_block(narrow_cell);
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x += curvature * Vec3(-x.x() * x.z(), 0, x.x() * x.x() / 2);
  const double stiffness =
      2 * ShapeMemory(tissue, {.stiffness = k}, 0).energy(motion.step()) / (curvature * curvature * a);
  const double beam = 2 * k * a / (b * c) * b * c * c * c / 12;
  EXPECT_NEAR(stiffness / beam, 3, 1e-5);
}

TEST(ShapeMemory, ViscosityIsThatOfTheCorotationalLaw) {
  const Tissue tissue = build_block(narrow_cell);
  const double viscosity = 3, rate = 1e-6;
  const ShapeMemory law(tissue, {.stiffness = 1e-12}, viscosity);
  Mat3 F = Mat3::Identity();
  F(0, 2) = rate;
  Motion motion = deformed(tissue, F);
  F(0, 2) = -2 * rate;
  motion.earlier_positions = deformed(tissue, F).positions;
  for (const double ahead : {0.0, 0.4}) {
    motion.ahead = ahead;
    const Vectors found = forces_of(law, motion.step());
    const Vectors expected = forces_of(
        Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(1e-12, 0.3)), viscosity), motion.step());
    for (std::size_t n = 0; n < 8; ++n) EXPECT_LE((found[n] - expected[n]).norm(), 1e-5 * largest(expected));
  }
}

TEST(ShapeMemory, RefusesAnInvertedRestShape) {
  Tissue tissue = build_block(narrow_cell);
  for (Vec3& X : tissue.element_rest_shape[0]) X.z() = -X.z();
  EXPECT_THROW(ShapeMemory(tissue, {.stiffness = 1}, 0), std::domain_error);
}

}  // namespace
