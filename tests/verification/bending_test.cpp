// Pure bending of a strip one cell thick under plane strain, against E/(1 - nu^2) I per width: bending of the sheet is
// the physics of a fold, and one cell is its whole thickness.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/elasticity/neo_hookean.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/linear_statics.hpp"
#include "support/loads.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double young = 1, length = 160, width = 20, height = 40;
const double inertia = width * height * height * height / 12;

Tissue strip() {
  return build_block({.length_um = length, .width_um = width, .cell_height_um = height, .cells = {8, 1, 1}});
}

/// Moment over curvature of a strip whose ends are turned against each other, from the supports' forces.
double bending_stiffness(const Tissue& tissue, double poisson) {
  const double curvature = 1e-3;  // linear: its size does not matter
  LinearStatics statics(tissue, ElasticModuli::from_young(young, poisson));
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& X = tissue.rest_positions[n];
    statics.prescribe(n, 1, 0);  // plane strain
    if (std::abs(X.x()) == length / 2) statics.prescribe(n, 0, -curvature * X.x() * X.z());
  }
  statics.prescribe(0, 2, 0);
  const Vectors reactions = statics.reactions(statics.solve());
  double moment = 0;
  for (std::size_t n = 0; n < tissue.node_count(); ++n)
    if (tissue.rest_positions[n].x() == length / 2) moment -= reactions[n].x() * tissue.rest_positions[n].z();
  return moment / curvature;
}

TEST(Bending, OneCellThickStripHasTheExactPlaneStrainStiffness) {
  int cases = 0;
  for (const double poisson : {0.3, 0.45, 0.499}) {
    const double ratio = bending_stiffness(strip(), poisson) / (young / (1 - poisson * poisson) * inertia);
    std::printf("bending, nu = %.3f: moment over exact %.6f\n", poisson, ratio);
    EXPECT_NEAR(ratio, 1, 0.02);
    EXPECT_NEAR(ratio, 1, 1e-9) << "bricks contain the exact field";
    ++cases;
  }
  RecordProperty("cases", cases);
}

// Cells of the pill are not bricks. Inner nodes moved along the strip by up to 2 um: no longer exact, and no longer
// soft.
TEST(Bending, DistortedCellsStayClose) {
  int cases = 0;
  for (const double poisson : {0.3, 0.45, 0.499}) {
    const Tissue brick = strip();
    Random random(1);
    Vectors positions = brick.rest_positions;
    for (Vec3& X : positions)
      if (std::abs(X.x()) < length / 2 - 1) X.x() += random.number(2);
    const double ratio =
        bending_stiffness(with_rest_positions(brick, positions), poisson) / (young / (1 - poisson * poisson) * inertia);
    std::printf("bending, nu = %.3f, nodes moved by up to 2 um: moment over exact %.4f\n", poisson, ratio);
    EXPECT_NEAR(ratio, 1, 0.1);
    ++cases;
  }
  RecordProperty("cases", cases);
}

// Moment over the exact one of a strip whose cells' volumes are held: couples at the ends, one long step without drag.
double ratio_with_held_volumes(Model model, double poisson) {
  const Tissue& tissue = model.tissue;
  const double stiffness = young / (1 - poisson * poisson) * inertia;
  const double curvature = 1e-5, force = stiffness * curvature / (2 * height);  // at each of four corners
  Vectors loads(tissue.node_count(), Vec3::Zero());
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const Vec3& X = tissue.rest_positions[n];
    model.held[n][1] = true;
    if (X.x() == -length / 2) model.held[n][0] = true;
    if (X.x() == length / 2 && std::abs(X.z()) == height / 2) loads[n].x() = X.z() > 0 ? -force : force;
  }
  model.held[0][2] = true;
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  NewtonStepper solver(model);
  State state = rest_state(model);
  const StepReport report = solver.advance(rest_state(model), 1e6, true, state);
  EXPECT_TRUE(report.converged()) << report.reason();
  double angle = 0;
  for (std::size_t n = 0; n < tissue.node_count(); ++n)
    if (loads[n].x() != 0) angle -= (state.positions[n].x() - length / 2) / (tissue.rest_positions[n].z() * 4);
  return curvature / (angle / length);
}

// In pure bending the mean dilatation of a cell is zero, so holding its volume changes nothing.
TEST(Bending, ExactCellVolumesDoNotStiffenIt) {
  int cases = 0;
  for (const double poisson : {0.3, 0.45, 0.499}) {
    Model model(strip());
    const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
    model.laws.push_back(std::make_unique<Corotational>(model.tissue, moduli, 0));
    model.laws.push_back(std::make_unique<Dilatation>(model.tissue, moduli.bulk_modulus()));
    const double ratio = ratio_with_held_volumes(std::move(model), poisson);
    std::printf("bending, nu = %.3f, cell volumes held: moment over exact %.6f\n", poisson, ratio);
    EXPECT_NEAR(ratio, 1, 0.02);
    ++cases;
  }
  RecordProperty("cases", cases);
}

double ratio_of_neo_hookean(double poisson, const std::array<int, 3>& elements_per_cell) {
  Model model(build_block({.length_um = length,
                           .width_um = width,
                           .cell_height_um = height,
                           .cells = {8, 1, 1},
                           .elements_per_cell = elements_per_cell}));
  const ElasticModuli moduli = ElasticModuli::from_young(young, poisson);
  model.laws.push_back(std::make_unique<NeoHookean>(model.tissue, std::vector<double>(8, moduli.shear_modulus)));
  model.laws.push_back(std::make_unique<Dilatation>(model.tissue, moduli.lame_lambda, true));
  const double ratio = ratio_with_held_volumes(std::move(model), poisson);
  std::printf("bending, neo-hookean, nu = %.2f, %d elements a cell along and %d high: moment over exact %.4f\n",
              poisson, elements_per_cell[0], elements_per_cell[2], ratio);
  return ratio;
}

// What neo-Hookean elements make of it, without incompatible modes, is known: docs/theory/neo_hookean.md.
TEST(Bending, NeoHookeanCellsShearWhereTheyBend) {
  int cases = 0;
  for (const double poisson : {0.0, 0.3, 0.45})
    for (const int along : {1, 3}) {
      const double l = length / (8 * along);
      EXPECT_NEAR(ratio_of_neo_hookean(poisson, {along, 1, 1}), (1 - poisson) * (1 + l * l / (2 * height * height)),
                  0.002);
      ++cases;
    }
  RecordProperty("cases", cases);
}

// With two elements through the height the mean volumes of both layers bring three quarters of what is missing.
TEST(Bending, TwoLayersOfNeoHookeanElementsAreStiffer) {
  const double one = ratio_of_neo_hookean(0.45, {3, 1, 1}), two = ratio_of_neo_hookean(0.45, {3, 1, 2});
  EXPECT_GT(two, 1 - 0.35 * (1 - one));
  EXPECT_LT(two, 1);
}

}  // namespace
}  // namespace plica
