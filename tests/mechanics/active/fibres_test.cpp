// Fibres of apical and basal cortices: one axis pulls more than the other.
#include "mechanics/active/fibres.hpp"

#include "mechanics/active/cortex.hpp"
#include "mechanics/division.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/cortices.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace {

CellSet every(const Tissue& tissue) { return CellSet(tissue.cells.size(), true); }

// Each cell has its own direction.
CortexRule fibred_rule(CellSide side, double share) {
  CortexRule rule = whole_cortex(side);
  rule.fibres = {share, 90, {{0, 20, -30, 45, 90, 170}}};
  return rule;
}

TEST(Fibres, DerivativesAgreeWithFiniteDifferences) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 2, 3);
  for (const CellSide side : {CellSide::apical, CellSide::basal})
    for (const double share : {0.4, 1.0}) {
      const Cortex law(tissue, every(tissue), fibred_rule(side, share));
      check_derivatives(law, tissue, 2);
      check_semidefinite_tangent(law, tissue, 2, share < 1);
      check_energy_flow(law, tissue);
      expect_no_resultant_and_no_torque(
          Cortex(tissue, every(tissue), {.side = side, .tension = 1.4, .saturation = 0.2, .fibres = {share, 20, {}}}),
          tissue, 2);
      std::vector<double> internal = law.first_internal(tissue);
      Random random(4);
      for (double& ratio : internal) ratio += random.number(0.2);
      check_law_derivatives(law, tissue, 2, internal);
    }
}

TEST(Fibres, AreTheSameForEveryInstructionSet) {
  const Tissue tissue =
      distorted_block({.length_um = 140, .width_um = 60, .cell_height_um = 30, .cells = {7, 3, 1}}, 3, 5);
  const Motion motion = random_motion(tissue, 3, 8);
  const CortexRule rule{.tension = 1, .saturation = 0.2, .fibres = {0.7, 30, {}}};
  Vectors expected;
  for (const Kernels kernels : available_kernels()) {
    const Vectors forces = forces_of(Cortex(tissue, every(tissue), rule, kernels), motion.step());
    if (expected.empty()) expected = forces;
    EXPECT_LE(largest_distance(forces, expected), 1e-13 * largest(expected)) << name(kernels);
  }
}

// The pull of a flat sheet at its end and at its side, over their widths.
std::pair<double, double> pulls(const Tissue& tissue, const CortexRule& rule, double length, double width) {
  const Vectors forces = forces_of(Cortex(tissue, every(tissue), rule), at_rest(tissue).step());
  std::pair<double, double> pull{0, 0};
  for (std::size_t n = 0; n < forces.size(); ++n) {
    if (tissue.rest_positions[n].x() > 0.5 * length - 1e-9) pull.first -= forces[n].x() / width;
    if (tissue.rest_positions[n].y() > 0.5 * width - 1e-9) pull.second -= forces[n].y() / length;
  }
  return pull;
}

// T along and (1 - share) T across, by any way to say the direction, on either side.
TEST(Fibres, PullASheetAlongTheirAxis) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 24, .cell_height_um = 10, .cells = {6, 3, 1}});
  const CellArray right_angles(18, 90.0);
  for (const CellSide side : {CellSide::apical, CellSide::basal}) {
    const auto expect = [&](const FibreRule& fibres, double along, double across) {
      const auto [at_end, at_side] = pulls(tissue, {.side = side, .tension = 0.8, .fibres = fibres}, 60, 24);
      EXPECT_NEAR(at_end, along, 1e-12);
      EXPECT_NEAR(at_side, across, 1e-12);
    };
    expect({0.75, 0, {}}, 0.8, 0.2);
    expect({0.75, 90, {}}, 0.2, 0.8);
    expect({0.75, 0, right_angles}, 0.2, 0.8);
    expect({0.75, 90, right_angles}, 0.8, 0.2);
    expect({0.75, 45, {}}, 0.5, 0.5);
    // A stretch by 1.2 along fibres at 30 degrees, seen from the apical side.
    Motion motion = at_rest(tissue);
    const Vec3 fibre(std::cos(std::numbers::pi / 6), 0.5, 0);
    for (Vec3& x : motion.positions) x += 0.2 * x.dot(fibre) * fibre;
    const Cortex law(tissue, every(tissue), {.side = side, .tension = 1, .fibres = {1, 30, {}}});
    for (const double measure : law.areas(motion.positions)) EXPECT_NEAR(measure, 80 * 1.2, 1e-10);
  }
}

// A sheet that is rolled up about its axis: fibres round the tube press on it with T/R, and along the axis not at all;
// along the tube they do not press, and pull at its ends.
TEST(Fibres, PressOnATubeByLaplacesLaw) {
  constexpr int around = 24;
  constexpr double radius = 50, length = 40;
  const double width = 2 * std::numbers::pi * radius;
  const Tissue tissue =
      build_block({.length_um = length, .width_um = width, .cell_height_um = 10, .cells = {4, around, 1}});
  for (const bool is_hoop : {true, false}) {
    const Cortex law(tissue, every(tissue), {.tension = 0.8, .fibres = {1, is_hoop ? 90.0 : 0.0, {}}});
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) {
      const double angle = x.y() / radius, at = radius + x.z() - 5;
      x = {x.x(), at * std::sin(angle), at * std::cos(angle)};
    }
    const Vectors forces = forces_of(law, motion.step());
    int inner = 0;
    for (std::size_t n = 0; n < forces.size(); ++n) {
      const Vec3& X = tissue.rest_positions[n];
      if (X.z() < 4.9 || std::abs(X.x()) > 0.4 * length || std::abs(X.y()) > 0.45 * width) continue;
      const Vec3& x = motion.positions[n];
      const double area = length / 4 * width / around;
      const double pressure = -forces[n].dot(Vec3(0, x.y(), x.z()).normalized()) / area;
      // A chord of an angle a leans inward by a/2 at either end: the pressure is T/R times sin(a/2)/(a/2), 0.9971.
      EXPECT_NEAR(pressure, is_hoop ? 0.8 / radius : 0, 0.003 * 0.8 / radius);
      EXPECT_NEAR(forces[n].x(), 0, 1e-12);
      ++inner;
    }
    EXPECT_GT(inner, 50);
  }
}

// Stretches of a neo-Hookean block of held volume under equal cortices on both sides.
Vec3 stretches(double share, double tension, double modulus, double height) {
  Model model(build_block({.length_um = 40, .width_um = 40, .cell_height_um = height, .cells = {2, 2, 1}}));
  const Tissue& tissue = model.tissue;
  model.stiffness_scale = modulus;
  model.laws.push_back(
      std::make_unique<NeoHookean>(tissue, std::vector<NeoHookeanMaterial>(tissue.elements.size(), {modulus, 0})));
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const bool has_x = tissue.rest_positions[n].x() == 0, has_y = tissue.rest_positions[n].y() == 0;
    model.held[n] = {has_x, has_y, has_x && has_y && tissue.rest_positions[n].z() < 0};
  }
  for (const CellSide side : {CellSide::apical, CellSide::basal})
    model.laws.push_back(std::make_unique<Cortex>(
        tissue, every(tissue), CortexRule{.side = side, .tension = tension, .fibres = {share, 0, {}}}));
  NewtonStepper stepper(model, {.force = 1e-10});
  State state;
  const StepReport report = stepper.advance(rest_state(model), 1, true, state);
  EXPECT_TRUE(report.converged()) << report.reason();
  if (!report.converged()) return Vec3::Zero();
  Vec3 low = state.positions.front(), high = low;
  for (const Vec3& x : state.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  return (high - low).cwiseQuotient(Vec3(40, 40, height));
}

// With the measure M = (1 - q) a b + q a by stretches a, b, c (a b c = 1): the nominal stresses are
// mu (a - c^2/a) = -2 T/H ((1 - q) b + q) and mu (b - c^2/b) = -2 T/H (1 - q) a.
TEST(Fibres, ShortenABlockAlongOneAxis) {
  constexpr double tension = 0.5, modulus = 0.3, height = 20;
  for (const double share : {0.0, 0.6, 1.0}) {
    const Vec3 found = stretches(share, tension, modulus, height);
    const double a = found.x(), b = found.y(), c = found.z(), pull = -2 * tension / height;
    EXPECT_NEAR(a * b * c, 1, 1e-9);
    EXPECT_NEAR(modulus * (a - c * c / a), pull * ((1 - share) * b + share), 1e-8) << share;
    EXPECT_NEAR(modulus * (b - c * c / b), pull * (1 - share) * a, 1e-8) << share;
    if (share == 1) {
      EXPECT_NEAR(b, c, 1e-8);
    }
  }
}

// Daughters have their mother's fibres.
TEST(Fibres, AreHandedOnToDaughters) {
  Tissue tissue = build_block({.length_um = 60, .width_um = 60, .cell_height_um = 30, .cells = {3, 3, 1}});
  const CellArray angles = {0, 10, 20, 30, 40, 50, 60, 70, 80};
  const CortexRule rule{.tension = 1, .saturation = 0, .fibres = {0.8, 0, angles}};
  const auto before = std::make_unique<Cortex>(tissue, every(tissue), rule);
  const auto turned = [&](const Tissue& at) {
    Motion motion = at_rest(at);
    for (Vec3& x : motion.positions) x = {1.3 * x.x(), 0.8 * x.y() + 0.2 * x.x(), x.z()};
    return motion;
  };
  const double energy = before->energy(turned(tissue).step());
  const TissueChange division = divide(tissue, std::vector<CellCut>{{CellId(4), 0}, {CellId(7), 1}}, 0);
  const auto after = before->after_change(tissue, division, tissue.rest_positions);
  EXPECT_NEAR(after->energy(turned(tissue).step()), energy, 1e-12 * energy);
  const auto restored = after->restored(tissue, no_change(tissue), tissue.rest_positions, after->past());
  EXPECT_NEAR(restored->energy(turned(tissue).step()), energy, 1e-12 * energy);
}

// Cells that are 1.6 times as long as wide, however they lie in space and were in the reference state: fibres have the
// share (1.6^2 - 1)/(1.6^2 + 1) of that of a line.
TEST(Fibres, TurnWithTheirCells) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}});
  const double share = 0.8, elongation = 1.6, anisotropy = (1.6 * 1.6 - 1) / (1.6 * 1.6 + 1);
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 axis = Vec3(1, 0.6, 0).normalized();
  Motion motion = at_rest(tissue);
  for (Vec3& x : motion.positions) x = turn * Vec3(x + (elongation - 1) * x.dot(axis) * axis);
  motion.previous_positions = motion.positions;
  for (const FibreAxis of : {FibreAxis::long_axis, FibreAxis::stretch})
    for (const CellSide side : {CellSide::apical, CellSide::basal}) {
      const Cortex law(tissue, every(tissue), {.side = side, .tension = 1, .fibres = {share, 0, {}, of}});
      // Both are a stretch of squares of 20 um: M = (1 - q a) A + q a l A_r = A here, by any share.
      EXPECT_NEAR(law.energy(motion.step()), 6 * 400 * elongation, 1e-9);
      Motion later = motion;
      for (Vec3& x : later.positions) x += 0.1 * x.dot(turn * axis) * (turn * axis);
      EXPECT_NEAR(law.energy(later.step()), 6 * 400 * elongation * 1.1, 1e-9);
      later = motion;
      const Vec3 across = turn * Vec3(-axis.y(), axis.x(), 0);
      for (Vec3& x : later.positions) x += 0.1 * x.dot(across) * across;
      EXPECT_NEAR(law.energy(later.step()), 6 * 400 * elongation * (1 + 0.1 * (1 - share * anisotropy)), 1e-9);
    }
}

TEST(Fibres, ThatTurnHaveDerivativesOfTheirEnergy) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 30, .cells = {3, 2, 1}}, 2, 3);
  for (const FibreAxis of : {FibreAxis::long_axis, FibreAxis::stretch})
    for (const CellSide side : {CellSide::apical, CellSide::basal}) {
      const Cortex law(tissue, every(tissue),
                       {.side = side, .tension = 1.4, .saturation = 0.2, .fibres = {0.9, 0, {}, of}});
      check_derivatives(law, tissue, 2);
      check_energy_flow(law, tissue);
      expect_no_resultant_and_no_torque(law, tissue, 2);
      EXPECT_SAYS(error_of<NoGradient>([&] { return &law.derivatives(); }), "fibres that turn");
    }
}

// Round cells are pulled alike in all directions, by any share.
TEST(Fibres, ThatTurnHaveNoEffectInRoundCells) {
  const Tissue tissue = build_block({.length_um = 60, .width_um = 60, .cell_height_um = 10, .cells = {3, 3, 1}});
  const auto [along, across] = pulls(tissue, {.tension = 0.8, .fibres = {1, 0, {}, FibreAxis::long_axis}}, 60, 60);
  EXPECT_NEAR(along, 0.8, 1e-12);
  EXPECT_NEAR(across, 0.8, 1e-12);
}

}  // namespace
