#include "mechanics/elasticity/neo_hookean.hpp"

#include "core/threads.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/hexahedron_stiffness.hpp"
#include "solver/step/backward_difference.hpp"
#include "support/divided.hpp"
#include "support/elements.hpp"
#include "support/law_checks.hpp"

namespace {

const BlockShape oblong_cell{.length_um = 20, .width_um = 30, .cell_height_um = 40, .cells = {1, 1, 1}};

NeoHookean law_of(const Tissue& tissue, double mu, double relaxation_s = 0, Kernels kernels = chosen_kernels()) {
  return {tissue, std::vector<NeoHookeanMaterial>(tissue.elements.size(), {mu, relaxation_s}), kernels};
}

/// First Piola-Kirchhoff stress of a brick of one cell: the forces on its faces over their areas at rest.
Mat3 stress(const Tissue& brick, const Vectors& forces) {
  const HexPoints& X = brick.element_rest_shape[0];
  const Vec3 size = X[6] - X[0];
  Mat3 P = Mat3::Zero();
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (brick.rest_positions[n][axis] > X[6][axis] - 1e-9) P.col(axis) -= forces[n];
    P.col(axis) /= size.prod() / size[axis];
  }
  return P;
}

// A motion whose rest shapes have flowed already, and are to flow on.
Motion flowing_motion(const NeoHookean& law, const Tissue& tissue, double size_um, unsigned seed) {
  Motion motion = random_motion(tissue, size_um, seed + 20);
  motion.internal = law.first_internal(tissue);
  const std::vector<double> once = law.next_internal(motion.step());
  motion = random_motion(tissue, size_um, seed);
  motion.internal = once;
  return motion;
}

TEST(NeoHookean, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_derivatives(law_of(tissue, 0.4), tissue, 3);
  check_derivatives(law_of(tissue, 0.4, 2), tissue, 3);
  const NeoHookean law(tissue, materials_of(tissue, {0.4, 0.1}, {2, 0}));
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const Motion motion = flowing_motion(law, tissue, 3, seed);
    expect_forces_are_minus_energy_gradient(law, motion, 1e-6);
    expect_tangent_is_minus_force_gradient(law, motion, 1e-6);
    expect_assembled_is_matrix_free(law, motion, seed);
  }
}

TEST(NeoHookean, DerivativesOfARunAgreeWithFiniteDifferences) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  const NeoHookean law(tissue, materials_of(tissue, {0.4, 0.1}, {2, 0}));
  check_law_derivatives(law, tissue, 2, flowing_motion(law, tissue, 2, 1).internal);
}

// Also after growth of rest shapes and division.
TEST(NeoHookean, StrengthsOfCellsScaleTheirModuli) {
  Model model(build_block(two_cells));
  const auto expect_alike = [](const Law& law, const NeoHookean& expected, const Tissue& tissue) {
    const Motion motion = flowing_motion(expected, tissue, 2, 1);
    const Eigen::VectorXd forces = flat(forces_of(expected, motion.step()));
    EXPECT_LE((flat(forces_of(law, motion.step())) - forces).norm(), 1e-13 * forces.norm());
    EXPECT_GT(forces.norm(), 0);
  };
  const NeoHookean even(model.tissue, materials_of(model.tissue, {0.4, 0.4}, {2, 0}));
  const std::unique_ptr<Law> law = with_strengths(even, std::vector<double>{1, 0.25});
  expect_alike(*law, {model.tissue, materials_of(model.tissue, {0.4, 0.1}, {2, 0})}, model.tissue);
  Tissue larger = model.tissue;
  for (HexPoints& rest : larger.element_rest_shape)
    for (Vec3& corner : rest) corner *= 1.1;
  const std::vector<ElementId> all = {ElementId(0), ElementId(1)};
  expect_alike(*law->grown(larger, all, {}), {larger, materials_of(larger, {0.4, 0.1}, {2, 0})}, larger);
  model.laws.push_back(law->clone());
  State state = rest_state(model);
  divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 1}}});
  expect_alike(*model.laws[0], {model.tissue, materials_of(model.tissue, {0.4, 0.1, 0.1}, {2, 0, 0})}, model.tissue);
}

TEST(NeoHookean, SemidefiniteTangentIsStifferAlongRotations) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  check_semidefinite_tangent(law_of(tissue, 0.4), tissue, 4, true);
  check_semidefinite_tangent(law_of(tissue, 0.4, 2), tissue, 4, true);
}

// Where nothing is indefinite at a Gauss point, it is all of the tangent.
TEST(NeoHookean, SemidefiniteTangentIsExactWhereThatIsSemidefinite) {
  const Tissue tissue = build_block(oblong_cell);
  const NeoHookean law = law_of(tissue, 0.4);
  Motion motion = deformed(tissue, Vec3(1.1, 1.2, 1.15).asDiagonal());
  const Eigen::MatrixXd exact = DenseTangent(law, motion.step()).matrix;
  motion.semidefinite_tangent = true;
  EXPECT_LE((DenseTangent(law, motion.step()).matrix - exact).norm(), 1e-12 * exact.norm());
}

TEST(NeoHookean, RestShapeHasNoForceAndTurningGivesNone) {
  const Tissue tissue = distorted_block(two_cells, 2, 7);
  const NeoHookean law = law_of(tissue, 0.4, 2);
  Motion motion = deformed(tissue, Random(3).rotation());
  motion.internal = law.first_internal(tissue);
  EXPECT_LE(largest(forces_of(law, motion.step())), 1e-12);
  EXPECT_LE(std::abs(law.energy(motion.step())), 1e-9);
  motion = flowing_motion(law, tissue, 3, 4);
  const Vectors forces = forces_of(law, motion.step());
  EXPECT_LE(resultant(forces).norm(), 1e-12 * largest(forces));
  EXPECT_LE(torque(forces, motion.positions).norm(), 1e-10 * largest(forces));
}

// P = mu (F - F^-T): stretched 2.5 times, squeezed to 0.3, sheared by 2.
TEST(NeoHookean, StressAtLargeStrainsIsTheKnownOne) {
  const Tissue tissue = build_block(oblong_cell);
  const NeoHookean law = law_of(tissue, 0.4);
  for (const double stretch : {2.5, 0.3}) {
    const Mat3 P = stress(tissue, forces_of(law, deformed(tissue, Vec3(stretch, 0.9, 1.4).asDiagonal()).step()));
    for (int axis = 0; axis < 3; ++axis) {
      const double l = axis == 0 ? stretch : axis == 1 ? 0.9 : 1.4;
      EXPECT_NEAR(P(axis, axis), 0.4 * (l - 1 / l), 1e-13);
    }
  }
  Mat3 F = Mat3::Identity();
  F(0, 2) = 2;
  const Mat3 P = stress(tissue, forces_of(law, deformed(tissue, F).step()));
  EXPECT_NEAR(P(0, 2), 0.4 * 2, 1e-13);
  EXPECT_NEAR(P(2, 0), 0.4 * 2, 1e-13);
  EXPECT_NEAR(P(0, 0), 0, 1e-13);
}

// With Dilatation of modulus lambda, small strains have Young's modulus and Poisson's ratio.
TEST(NeoHookean, WithDilatationSmallStrainsHaveTheModuli) {
  const Tissue tissue = build_block(oblong_cell);
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.3);
  const NeoHookean law = law_of(tissue, moduli.shear_modulus);
  const Dilatation dilatation(tissue, in_elements(tissue, moduli.lame_lambda), false);
  const double strain = 1e-6;
  const Motion motion = deformed(tissue, Vec3(1 + strain, 1 - 0.3 * strain, 1 - 0.3 * strain).asDiagonal());
  Vectors forces = forces_of(law, motion.step());
  const Vectors more = forces_of(dilatation, motion.step());
  for (std::size_t n = 0; n < forces.size(); ++n) forces[n] += more[n];
  const Mat3 P = stress(tissue, forces);
  EXPECT_NEAR(P(0, 0) / strain, 1, 1e-5);
  EXPECT_NEAR(P(1, 1) / strain, 0, 1e-5);
  EXPECT_NEAR(P(2, 2) / strain, 0, 1e-5);
}

TEST(NeoHookean, IsInfiniteWhereAGaussPointIsInsideOut) {
  const Tissue tissue = build_block(oblong_cell);
  const NeoHookean law = law_of(tissue, 0.4);
  const auto flat = [&](double height) { return deformed(tissue, Vec3(1, 1, height).asDiagonal()); };
  EXPECT_GT(law.energy(flat(1e-6).step()), law.energy(flat(1e-3).step()));
  EXPECT_TRUE(std::isinf(law.energy(flat(-0.1).step())));
  EXPECT_FALSE(forces_of(law, flat(-0.1).step())[0].allFinite());
}

TEST(NeoHookean, EveryInstructionSetAndAnyThreadsHaveTheSame) {
  const Tissue tissue = build_shell({.cells = {18, 9, 8}, .elements_per_cell = {3, 2, 1}});
  for (const double relaxation_s : {0.0, 3.0}) {
    Vectors expected;
    for (const Kernels kernels : available_kernels()) {
      const NeoHookean law = law_of(tissue, 0.4, relaxation_s, kernels);
      const Motion motion = flowing_motion(law, tissue, 0.5, 2);
      const Vectors direction = Random(6).vectors(tissue.node_count());
      const auto results = [&](int threads) {
        const ThreadCount scope(threads);
        Vectors sums = forces_of(law, motion.step());
        law.add_tangent_product(motion.step(), direction, sums);
        return std::tuple(sums, law.energy(motion.step()), law.next_internal(motion.step()));
      };
      const auto one = results(1);
      for (const int threads : {2, 4}) EXPECT_EQ(one, results(threads)) << name(kernels);
      if (expected.empty()) expected = std::get<0>(one);
      for (std::size_t n = 0; n < expected.size(); ++n)
        ASSERT_LE((std::get<0>(one)[n] - expected[n]).norm(), 1e-12 * largest(expected)) << name(kernels);
    }
  }
}

// Small strains, held: stress decays as exp(-t/tau), to the order of the steps.
TEST(NeoHookean, HeldStressDecaysAsMaxwellSays) {
  const Tissue tissue = build_block(oblong_cell);
  const double tau = 6;
  const NeoHookean law = law_of(tissue, 0.4, tau);
  Motion motion = deformed(tissue, Vec3(1.001, 1 / std::sqrt(1.001), 1 / std::sqrt(1.001)).asDiagonal());
  motion.internal = law.first_internal(tissue);
  motion.rate_s = 1e-9;
  const double first = stress(tissue, forces_of(law, motion.step()))(0, 0);
  const int steps = 2000;
  motion.rate_s = tau / steps;
  double last = 0;
  for (int k = 0; k < steps; ++k) {
    last = stress(tissue, forces_of(law, motion.step()))(0, 0);
    motion.internal = law.next_internal(motion.step());
  }
  EXPECT_NEAR(last / first, std::exp(-1.0), 1e-3);
}

// A large, changing strain, against SciPy's integration of the flow (tests/verification/maxwell_truth.py), in steps of
// first and of second order: the error falls by 2 and by 4 when they are halved.
TEST(NeoHookean, FlowsAtLargeStrainsAsAnotherIntegratorSays) {
  const Tissue tissue = build_block(oblong_cell);
  const double tau = 60;
  const NeoHookean law = law_of(tissue, 1, tau);
  const auto gradient = [](double t) {
    const double stretch = 1 + 0.8 * std::min(t, 1.0), across = std::pow(stretch, -0.4);
    Mat3 F = Vec3(stretch, across, across).asDiagonal();
    F(0, 2) = 0.6 * std::sin(2 * t);
    return F;
  };
  const std::vector<Mat3> truth = [] {
    Mat3 half, one, two;
    half << 0.4476623444, 0, 0.3493969359, 0, -0.1899984213, 0, 0.2954730962, 0, -0.2144323233;
    one << 0.5211074374, 0, 0.0871539723, 0, -0.2313648528, 0, 0.1218139904, 0, -0.2756188251;
    two << 0.2278661020, 0, -0.7601685678, 0, 0.0522354407, 0, -0.3664428253, 0, -0.1292694855;
    return std::vector{half, one, two};
  }();
  for (const bool second_order : {false, true}) {
    std::vector<double> errors;
    for (const int steps : {100, 200, 400}) {  // in 2 tau
      const double h = 2 * tau / steps;
      Motion motion = at_rest(tissue);
      motion.internal = law.first_internal(tissue);
      double error = 0;
      for (int k = 1; k <= steps; ++k) {
        // What lies before the first step and before the bend of the stretch says nothing of what comes.
        const bool second = second_order && k != 1 && k != steps / 2 + 1;
        const BackwardDifference rates = second ? backward_difference(h, h) : BackwardDifference{h, 0};
        motion.rate_s = rates.rate_s;
        motion.ahead = rates.ahead;
        motion.positions = deformed(tissue, gradient(k * h / tau)).positions;
        for (int at = 0; at < 3; ++at)
          if (4 * k == steps * (at == 0 ? 1 : 2 * at))
            error = std::max(error, (stress(tissue, forces_of(law, motion.step())) - truth[at]).norm());
        motion.internal = law.next_internal(motion.step());
      }
      errors.push_back(error);
    }
    const double order = std::log2(errors[1] / errors[2]);
    std::printf("flow, %s order: stress off by %.1e, %.1e, %.1e in 100, 200, 400 steps: order %.2f\n",
                second_order ? "second" : "first", errors[0], errors[1], errors[2], order);
    EXPECT_NEAR(order, second_order ? 2 : 1, 0.15);
    EXPECT_LE(errors[2], second_order ? 2e-4 : 1e-2);
  }
}

TEST(NeoHookean, FlowKeepsVolume) {
  const Tissue tissue = distorted_block(two_cells, 2, 5);
  const NeoHookean law = law_of(tissue, 0.4, 2);
  const Motion motion = flowing_motion(law, tissue, 3, 1);
  const std::vector<double> next = law.next_internal(motion.step());
  double changed = 0;
  for (std::size_t e = 0; e < 2; ++e)
    for (int g = 0; g < 8; ++g) {
      const Mat3 Cp = law.flowed(next, ElementId(e), g);
      EXPECT_NEAR(Cp.determinant(), 1, 1e-13);
      changed = std::max(changed, (Cp - Mat3::Identity()).norm());
    }
  EXPECT_GT(changed, 0.1);
}

// Daughters have their mother's modulus, relaxation and flow; cells whose elements stay feel the same forces.
TEST(NeoHookean, DaughtersHaveTheirMothersFlow) {
  Model model(build_block({.length_um = 100, .width_um = 20, .cell_height_um = 40, .cells = {5, 1, 1}}));
  const std::vector<double> moduli = {0.4, 0.3, 0.2, 0.1, 0.5}, relaxation = {3, 2, 1, 0, 5};
  model.laws.push_back(std::make_unique<NeoHookean>(model.tissue, materials_of(model.tissue, moduli, relaxation)));
  State state = rest_state(model);
  Mat3 F = Vec3(1.4, 0.8, 0.9).asDiagonal();
  F(0, 2) = 0.3;
  for (Vec3& x : state.positions) x = F * x;
  const auto at = [&] {
    Step step{state.positions, state.positions, state.velocities, 0.7, 1};
    step.internal = state.internals[0];
    return step;
  };
  state.internals[0] = model.laws[0]->next_internal(at());
  state.internals[0] = model.laws[0]->next_internal(at());
  const auto flowed = [&](std::size_t e, int g) {
    return dynamic_cast<const NeoHookean&>(*model.laws[0]).flowed(state.internals[0], ElementId(e), g);
  };
  std::vector<Mat3> of_cell;
  for (std::size_t c = 0; c < 5; ++c) of_cell.push_back(flowed(c, 3));
  EXPECT_GT((of_cell[1] - Mat3::Identity()).norm(), 0.1);
  EXPECT_EQ(of_cell[3], Mat3::Identity());
  const Vectors before = forces_of(*model.laws[0], at());
  const double energy = model.laws[0]->energy(at());
  const TissueChange division = divide_cells(model, state, std::vector<PlannedDivision>{{{CellId(1), 1}}});
  ASSERT_GT(model.tissue.elements.size(), 6u);
  for (std::size_t e = 0; e < model.tissue.elements.size(); ++e)
    for (int g = 0; g < 8; ++g)
      EXPECT_LE((flowed(e, g) - of_cell[division.origin[model.tissue.element_cell[e].index()].index()]).norm(), 1e-14);
  EXPECT_NEAR(model.laws[0]->energy(at()), energy, 1e-12 * energy);
  const Vectors after = forces_of(*model.laws[0], at());
  for (std::size_t n = 0; n < before.size(); ++n)
    if (model.tissue.rest_positions[n].x() > 10) {  // beyond the cells that are meshed anew
      EXPECT_LE((after[n] - before[n]).norm(), 1e-12 * largest(before));
    }
}

}  // namespace
