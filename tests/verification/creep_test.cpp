// Creep of a Kelvin-Voigt spring under a constant force: x(t) = (F/k)(1 - exp(-k t / c)), reached at first or second
// order in the step, and at any step the backward Euler of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "mechanics/active/contraction.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/loads.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double stiffness = 2, damping = 10, force = 4, length = 20;  // nN/um, nN s/um, nN, um

/// A brick so soft that it is not felt, all of it held but for one node that slides along the x edge under the force:
/// there is nothing but the spring on that edge.
Model one_spring() {
  Model model(build_block({.length_um = length, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  for (auto& directions : model.held) directions = {true, true, true};
  model.held[1][0] = false;
  model.volumes.hold(false);
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, ElasticModuli::from_young(1e-12, 0.3), 0));
  model.laws.push_back(std::make_unique<Contraction>(
      std::vector<Spring>{{{NodeId(0), NodeId(1)}, stiffness, 0, damping, length}}, Program{}));
  Vectors loads(8, Vec3::Zero());
  loads[1].x() = force;
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  return model;
}

/// Elongation after `steps` steps of `duration_s`.
double creep(double duration_s, int steps, TimeOrder order = TimeOrder::first) {
  const Model model = one_spring();
  NewtonStepper solver(model, {.force = 1e-12}, LinearMethod::automatic, order);
  State state = rest_state(model), next;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    if (!report.converged()) break;
    std::swap(state, next);
  }
  for (std::size_t n = 0; n < 8; ++n)
    if (n != 1) {
      EXPECT_EQ((state.positions[n] - model.tissue.rest_positions[n]).norm(), 0) << "held node " << n;
    }
  return state.positions[1].x() - model.tissue.rest_positions[1].x();
}

TEST(Creep, EveryStepIsBackwardEuler) {
  int cases = 0;
  for (const double h : {0.01, 1.0, 100.0}) {
    const double exact = force / stiffness * (1 - std::pow(1 + stiffness * h / damping, -10));
    EXPECT_NEAR(creep(h, 10), exact, 1e-9);
    ++cases;
  }
  RecordProperty("cases", cases);
}

void expect_convergence(TimeOrder order) {
  const double time = 5;  // one relaxation time c/k
  const double exact = force / stiffness * (1 - std::exp(-stiffness * time / damping));
  double previous = 0;
  int cases = 0;
  for (const int steps : {10, 20, 40, 80, 160}) {
    const double error = creep(time / steps, steps, order) - exact;
    std::printf("creep, %3d steps to c/k: %.6f um, error %.2e", steps, exact + error, error);
    if (previous != 0) {
      const double found = std::log2(previous / error);
      std::printf(", order %.3f", found);
      if (order == TimeOrder::first)
        EXPECT_NEAR(found, 1, 0.05);
      else
        EXPECT_NEAR(found, 2, 0.1);
    }
    std::printf("\n");
    previous = error;
    ++cases;
  }
  testing::Test::RecordProperty("cases", cases);
}

TEST(Creep, ConvergesToTheExponentialAtFirstOrder) { expect_convergence(TimeOrder::first); }

TEST(Creep, ConvergesToTheExponentialAtSecondOrder) { expect_convergence(TimeOrder::second); }

}  // namespace
}  // namespace plica
