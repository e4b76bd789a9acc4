// A spring under a constant force in a fluid: x(t) = (F/k)(1 - exp(-k t / D)), reached at second order in the step, on
// even steps and on uneven ones, and at any step the BDF2 of it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "mechanics/active/contraction.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/surroundings.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/loads.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double stiffness = 2, force = 4, length = 20;  // nN/um, nN, um
// One facet of 20 x 20 um has the node at a corner: drag 0.1 nN s/um^3 times a quarter of it.
constexpr double drag = 10;  // nN s/um
constexpr double relaxation_s = drag / stiffness;

/// A brick so soft that it is not felt, all of it held but for one node that slides along the x edge under the force.
Model one_spring_in_fluid() {
  Model model(build_block({.length_um = length, .width_um = 20, .cell_height_um = 40, .cells = {1, 1, 1}}));
  for (auto& directions : model.held) directions = {true, true, true};
  model.held[1][0] = false;
  model.volumes.hold(false);
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, ElasticModuli::from_young(1e-12, 0.3), 0));
  model.laws.push_back(std::make_unique<SurfaceDrag>(model.tissue, 0.1));
  model.laws.push_back(
      std::make_unique<Contraction>(std::vector<Spring>{{{NodeId(0), NodeId(1)}, stiffness, 0, 0, length}}, Program{}));
  Vectors loads(8, Vec3::Zero());
  loads[1].x() = force;
  model.laws.push_back(std::make_unique<NodalForces>(loads));
  return model;
}

using StepOf = std::function<double(int)>;

/// Elongations after each step.
std::vector<double> elongations(const StepOf& step_s, int steps) {
  const Model model = one_spring_in_fluid();
  NewtonStepper solver(model, {.force = 1e-12}, LinearMethod::automatic, TimeOrder::second);
  State state = rest_state(model), next;
  std::vector<double> all = {0};
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, step_s(k), k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    if (!report.converged()) break;
    std::swap(state, next);
    all.push_back(state.positions[1].x() - model.tissue.rest_positions[1].x());
  }
  return all;
}

// (1 + 2w)/(1 + w) x_n+1 - (1 + w) x_n + w^2/(1 + w) x_n-1 = h (F - k x_n+1) / D, w the ratio of steps; the first is
// backward Euler's. From textbooks, not from backward_difference().
TEST(SpringInFluid, EveryStepIsTheBackwardDifference) {
  int cases = 0;
  for (const StepOf& step_s : {StepOf([](int) { return 0.5; }), StepOf([](int) { return 50.0; }),
                               StepOf([](int k) { return k % 2 == 0 ? 1.0 : 0.45; })}) {
    const std::vector<double> ours = elongations(step_s, 12);
    double before = 0, x = 0;
    for (int k = 0; k < 12; ++k) {
      const double h = step_s(k), w = k > 0 ? h / step_s(k - 1) : 0;
      const double of_new = (1 + 2 * w) / (1 + w), of_old = 1 + w, of_older = w * w / (1 + w);
      const double next = (of_old * x - of_older * before + h * force / drag) / (of_new + h * stiffness / drag);
      before = std::exchange(x, next);
      EXPECT_NEAR(ours.at(k + 1), x, 1e-9) << "step " << k << " of " << h << " s";
      ++cases;
    }
  }
  RecordProperty("cases", cases);
}

TEST(SpringInFluid, ConvergesToTheExponentialAtSecondOrder) {
  int cases = 0;
  for (const double unevenness : {0.0, 0.3}) {
    double previous = 0;
    for (const int steps : {20, 40, 80, 160, 320}) {
      const double h = relaxation_s / steps;
      const auto step_s = [&](int k) { return h * (1 + (k % 2 == 0 ? unevenness : -unevenness)); };
      const double exact = force / stiffness * (1 - std::exp(-1));
      const double error = elongations(step_s, steps).back() - exact;
      std::printf("spring in a fluid, %3d %s steps to D/k: error %.2e um", steps, unevenness > 0 ? "uneven" : "even",
                  error);
      if (previous != 0) {
        const double order = std::log2(previous / error);
        std::printf(", order %.3f", order);
        EXPECT_NEAR(order, 2, 0.1);
      }
      std::printf("\n");
      previous = error;
      ++cases;
    }
  }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
