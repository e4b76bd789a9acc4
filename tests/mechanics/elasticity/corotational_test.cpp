#include "mechanics/elasticity/corotational.hpp"

#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/division.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"

namespace {

constexpr double young = 1.0;  // kPa: the paper's 1000 Pa
constexpr double poisson = 0.3;

const BlockShape one_cell{.length_um = 20, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}};

/// Force of a set of nodes, chosen by a predicate of their rest positions, on what is outside.
template <class Chosen>
Vec3 force_on(const Tissue& tissue, const Vectors& forces, const Chosen& chosen) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t n = 0; n < forces.size(); ++n)
    if (chosen(tissue.rest_positions[n])) sum += forces[n];
  return sum;
}

// Layers of a cell: an affine motion has the energy density of each layer's own modulus, and forces are those of the
// layers together.
TEST(Corotational, ElementsOfACellMayDiffer) {
  const Tissue tissue = build_block(
      {.length_um = 20, .width_um = 15, .cell_height_um = 12, .cells = {2, 1, 1}, .elements_per_cell = {1, 1, 3}});
  const ElasticModuli base = ElasticModuli::from_young(young, poisson);
  std::vector<ElasticModuli> moduli;
  std::vector<double> bulk;
  double expected = 0;
  Mat3 stretch = Mat3::Identity();
  stretch(0, 0) = 1.2, stretch(1, 1) = 0.9, stretch(0, 2) = stretch(2, 0) = 0.1;
  const Mat3 strain = stretch - Mat3::Identity(), deviator = strain - strain.trace() / 3 * Mat3::Identity();
  for (std::size_t e = 0; e < tissue.elements.size(); ++e) {
    const double factor = 1 + static_cast<double>(e % 3) * 4;
    moduli.push_back(factor * base);
    bulk.push_back(factor * base.bulk_modulus());
    expected += factor * base.shear_modulus * hex_volume(tissue.element_rest_shape[e]) * deviator.squaredNorm();
  }
  const Corotational law(tissue, moduli, 0);
  EXPECT_NEAR(law.energy(deformed(tissue, stretch).step()), expected, 1e-9 * expected);
  check_derivatives(law, tissue, 2);
  check_derivatives(Dilatation(tissue, bulk, false), tissue, 2);
  check_derivatives(NeoHookean(tissue, std::vector<NeoHookeanMaterial>{{1}, {2}, {3}, {4}, {5}, {6}}), tissue, 2);
}

TEST(Corotational, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_derivatives(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(young, poisson)), 0), tissue, 4);
}

TEST(Corotational, DerivativesAgreeWithFiniteDifferencesWithViscosity) {
  const Tissue tissue = distorted_block(two_cells, 2, 6);
  check_derivatives(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(young, 0.45)), 2), tissue, 4);
}

TEST(Corotational, SemidefiniteTangentLeavesOutTheTurningOfTheFrame) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_semidefinite_tangent(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(young, poisson)), 0),
                             tissue, 6, true);
  check_semidefinite_tangent(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(young, 0.45)), 2),
                             tissue, 6, true);
}

TEST(Corotational, EveryCellHasItsOwnModulus) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  const Motion motion = random_motion(tissue, 4, 3);
  const auto forces = [&](const std::vector<double>& factors) {
    Vectors sum = forces_of(Corotational(tissue, in_elements(tissue, moduli, factors), 0), motion.step());
    const Vectors dilatation =
        forces_of(Dilatation(tissue, in_elements(tissue, moduli.bulk_modulus(), factors), false), motion.step());
    for (std::size_t n = 0; n < sum.size(); ++n) sum[n] += dilatation[n];
    return sum;
  };
  const Vectors both = forces({2, 0.3}), first = forces({1, 0}), second = forces({0, 1});
  for (std::size_t n = 0; n < both.size(); ++n)
    EXPECT_LE((both[n] - 2 * first[n] - 0.3 * second[n]).norm(), 1e-13 * largest(both));
}

// Also after growth of rest shapes and division.
TEST(Corotational, StrengthsOfCellsScaleTheirModuli) {
  Model model(build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}}));
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  const std::vector<double> factors = {1, 0.2, 3};
  const auto law_of = [&](const Tissue& tissue, const std::vector<double>& of_cells) {
    return std::make_unique<Corotational>(tissue, in_elements(tissue, moduli, of_cells), 2);
  };
  const auto expect_alike = [](const Law& law, const Law& expected, const Tissue& tissue) {
    const Motion motion = random_motion(tissue, 3, 3);
    const Eigen::VectorXd forces = flat(forces_of(expected, motion.step()));
    EXPECT_LE((flat(forces_of(law, motion.step())) - forces).norm(), 1e-13 * forces.norm());
    EXPECT_GT(forces.norm(), 0);
  };
  const std::unique_ptr<Law> law = with_strengths(*law_of(model.tissue, {}), factors);
  expect_alike(*law, *law_of(model.tissue, factors), model.tissue);
  Tissue larger = model.tissue;
  for (HexPoints& rest : larger.element_rest_shape)
    for (Vec3& corner : rest) corner *= 1.1;
  const std::vector<ElementId> all = {ElementId(0), ElementId(1), ElementId(2)};
  expect_alike(*law->grown(larger, all, {}), *law_of(larger, factors), larger);
  model.laws.push_back(law->clone());
  State state = rest_state(model);
  const TissueChange division = divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 1}}});
  expect_alike(*model.laws[0], *law_of(model.tissue, inherited(division, factors)), model.tissue);
}

// Daughters have their mother's, in both laws.
TEST(Corotational, ModuliOfCellsAreInherited) {
  Model model(build_block({.length_um = 60, .width_um = 20, .cell_height_um = 40, .cells = {3, 1, 1}}));
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  const std::vector<double> factors = {1, 0.2, 3};
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, in_elements(model.tissue, moduli, factors), 0));
  model.laws.push_back(
      std::make_unique<Dilatation>(model.tissue, in_elements(model.tissue, moduli.bulk_modulus(), factors), false));
  State state = rest_state(model);
  const TissueChange division = divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 1}}});
  const std::vector<double> after = inherited(division, factors);
  ASSERT_EQ(after, (std::vector<double>{1, 0.2, 3, 0.2}));
  const Motion motion = random_motion(model.tissue, 3, 3);
  EXPECT_EQ(forces_of(*model.laws[0], motion.step()),
            forces_of(Corotational(model.tissue, in_elements(model.tissue, moduli, after), 0), motion.step()));
  EXPECT_EQ(forces_of(*model.laws[1], motion.step()),
            forces_of(Dilatation(model.tissue, in_elements(model.tissue, moduli.bulk_modulus(), after), false),
                      motion.step()));
}

TEST(Corotational, RestShapeHasNoForceAndNoEnergy) {
  const Tissue tissue = distorted_block(two_cells, 2, 7);
  const Corotational law(tissue, in_elements(tissue, ElasticModuli::from_young(young, poisson)), 1);
  const Motion rest = at_rest(tissue);
  EXPECT_LE(largest(forces_of(law, rest.step())), 1e-12);
  EXPECT_LE(law.energy(rest.step()), 1e-20);
}

// The mean volumetric part is Dilatation's, so both together are the linear elasticity that E and nu describe.
TEST(Corotational, UniaxialStretchOfABrickGivesYoungsModulus) {
  const Tissue tissue = build_block(one_cell);
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  const Corotational elasticity(tissue, in_elements(tissue, moduli), 0);
  const Dilatation dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false);
  const double strain = 1e-7;
  const Mat3 F = Vec3(1 - poisson * strain, 1 - poisson * strain, 1 + strain).asDiagonal();
  const Motion motion = deformed(tissue, F);
  Vectors forces = forces_of(elasticity, motion.step());
  dilatation.add_forces(motion.step(), forces);
  const Vec3 top = force_on(tissue, forces, [](const Vec3& X) { return X.z() > 0; });
  EXPECT_NEAR(top.z(), -young * strain * 20 * 20, 1e-6 * strain * 400);
  // Sides are free: each node has a quarter of the top's force along z and nothing across.
  for (const Vec3& f : forces) {
    EXPECT_NEAR(f.x(), 0, 1e-6 * strain * 400);
    EXPECT_NEAR(f.y(), 0, 1e-6 * strain * 400);
    EXPECT_NEAR(std::abs(f.z()), young * strain * 100, 1e-6 * strain * 400);
  }
}

// In the rotating frame a simple shear of angle gamma is a stretch; to first order the stress is G gamma.
TEST(Corotational, SimpleShearOfABrickGivesTheShearModulus) {
  const Tissue tissue = build_block(one_cell);
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  const double gamma = 1e-7;
  Mat3 F = Mat3::Identity();
  F(0, 2) = gamma;
  const Motion motion = deformed(tissue, F);
  const Vectors forces = forces_of(Corotational(tissue, in_elements(tissue, moduli), 0), motion.step());
  const Vec3 top = force_on(tissue, forces, [](const Vec3& X) { return X.z() > 0; });
  EXPECT_NEAR(top.x(), -young / (2 * (1 + poisson)) * gamma * 400, 1e-6 * gamma * 400);
  EXPECT_NEAR(top.z(), 0, 1e-6 * gamma * 400);
}

// What the two laws share out is the element's whole stiffness.
TEST(Corotational, TangentAtRestWithDilatationIsTheElementsStiffness) {
  const Tissue tissue = distorted_block(one_cell, 2, 12);
  const ElasticModuli moduli = ElasticModuli::from_young(young, 0.45);
  const Motion rest = at_rest(tissue);
  const Eigen::MatrixXd both =
      DenseTangent(Corotational(tissue, in_elements(tissue, moduli), 0), rest.step()).matrix +
      DenseTangent(Dilatation(tissue, in_elements(tissue, moduli.bulk_modulus()), false), rest.step()).matrix;
  const Mat24 K = incompatible_stiffness(tissue.element_rest_shape[0], moduli);
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j) {
      const Mat3 block = both.block<3, 3>(3 * tissue.elements[0][i].number(), 3 * tissue.elements[0][j].number());
      EXPECT_LE((block - K.block<3, 3>(3 * i, 3 * j)).cwiseAbs().maxCoeff(), 1e-12 * K.cwiseAbs().maxCoeff());
    }
}

// Finite stretch, where the law is linear in the Biot strain S - I: a volume-keeping stretch diag(1 + a, ...) of a
// brick has energy V (lambda tr^2 / 2 + G |S - I|^2) less kappa V tr^2 / 2 for the mean volumetric part.
TEST(Corotational, EnergyOfAFiniteStretchIsThatOfTheBiotStrain) {
  const Tissue tissue = build_block(one_cell);
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  const Corotational law(tissue, in_elements(tissue, moduli), 0);
  Random random(3);
  for (int k = 0; k < 5; ++k) {
    const Vec3 strain = random.vector(0.4);
    const Mat3 R = random.rotation(), Q = random.rotation();
    const Mat3 S = Q * Vec3(Vec3::Ones() + strain).asDiagonal() * Q.transpose();
    const double volume = 20 * 20 * 40, trace = strain.sum();
    const double expected = volume * moduli.shear_modulus * (strain.squaredNorm() - trace * trace / 3);
    EXPECT_NEAR(law.energy(deformed(tissue, R * S).step()), expected, 1e-10 * volume);
  }
}

TEST(Corotational, SimpleShearRateGivesTwiceViscosityTimesRate) {
  const double viscosity = 3, rate = 1e-6, duration = 0.5;
  const Tissue tissue = build_block(one_cell);
  // So soft that only the viscosity is felt.
  const Corotational law(tissue, in_elements(tissue, ElasticModuli::from_young(1e-12, poisson)), viscosity);
  Mat3 F = Mat3::Identity();
  F(0, 2) = rate * duration;
  Motion motion = deformed(tissue, F);
  motion.rate_s = duration;
  const Vectors forces = forces_of(law, motion.step());
  const Vec3 top = force_on(tissue, forces, [](const Vec3& X) { return X.z() > 0; });
  // D_xz = rate / 2, so the stress 2 eta D_xz = eta rate.
  EXPECT_NEAR(top.x(), -viscosity * rate * 400, 1e-6 * viscosity * rate * 400);
  // To second order after an equal step at the same rate: the shear was nothing, is half of this, and rate_s 2/3 of the
  // step.
  motion.earlier_positions = motion.previous_positions;
  F(0, 2) = rate * duration / 2;
  motion.previous_positions = deformed(tissue, F).positions;
  motion.rate_s = duration / 3;
  motion.ahead = 1.0 / 3;
  EXPECT_NEAR(force_on(tissue, forces_of(law, motion.step()), [](const Vec3& X) { return X.z() > 0; }).x(),
              -viscosity * rate * 400, 1e-6 * viscosity * rate * 400);
}

TEST(Corotational, ViscosityResistsNoUniformExpansion) {
  const Tissue tissue = build_block(one_cell);
  const Corotational law(tissue, in_elements(tissue, ElasticModuli::from_young(1e-12, poisson)), 3);
  const Motion motion = deformed(tissue, 1.01 * Mat3::Identity());
  EXPECT_LE(largest(forces_of(law, motion.step())), 1e-10);
}

TEST(Corotational, ViscosityDoesNotResistTurning) {
  const Tissue tissue = distorted_block(two_cells, 2, 8);
  const Corotational law(tissue, in_elements(tissue, ElasticModuli::from_young(young, poisson)), 100);
  Random random(4);
  for (int k = 0; k < 10; ++k) {
    Motion motion = deformed(tissue, random.rotation());
    EXPECT_LE(largest(forces_of(law, motion.step())), 1e-9);
    motion.earlier_positions = deformed(tissue, random.rotation()).positions;
    motion.ahead = 0.4;
    EXPECT_LE(largest(forces_of(law, motion.step())), 1e-9) << "to second order";
  }
}

TEST(Corotational, InternalForcesHaveNoResultantAndNoTorque) {
  const Tissue tissue = distorted_block(two_cells, 2, 9);
  expect_no_resultant_and_no_torque(
      Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(young, poisson)), 2), tissue, 4);
}

TEST(Corotational, StiffnessIsPositiveButForRigidMotions) {
  const Tissue tissue = distorted_block(one_cell, 2, 10);
  const Mat24 K = incompatible_stiffness(tissue.element_rest_shape[0], ElasticModuli::from_young(young, 0.49));
  const Eigen::SelfAdjointEigenSolver<Mat24> eigen(K);
  const double largest_value = eigen.eigenvalues()[23];
  for (int i = 0; i < 6; ++i) EXPECT_LE(std::abs(eigen.eigenvalues()[i]), 1e-13 * largest_value);
  EXPECT_GE(eigen.eigenvalues()[6], 1e-4 * largest_value);  // no hourglass modes
}

TEST(Corotational, MeanGradientsGiveAUniformDeformationBack) {
  const Tissue tissue = distorted_block(one_cell, 3, 11);
  const HexPoints& rest = tissue.element_rest_shape[0];
  Random random(5);
  Mat3 A;
  for (int i = 0; i < 3; ++i) A.col(i) = random.vector();
  Mat3 F = Mat3::Zero();
  const auto b = mean_gradients(rest);
  for (int i = 0; i < 8; ++i) F += (A * rest[i]) * b[i].transpose();
  EXPECT_LE((F - A).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(Corotational, RefusesAnInvertedRestShape) {
  Tissue tissue = build_block(one_cell);
  for (Vec3& X : tissue.element_rest_shape[0]) X.z() = -X.z();
  EXPECT_THROW(Corotational(tissue, in_elements(tissue, ElasticModuli::from_young(young, poisson)), 0),
               std::domain_error);
}

}  // namespace
