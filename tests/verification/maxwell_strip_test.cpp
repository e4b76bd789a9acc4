// A strip that is stretched at once and held: how its pull decays where its rest shape flows (Maxwell), against the
// flow's equation in one dimension. Cells keep their volumes, sides are free.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "mechanics/elasticity/neo_hookean.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

constexpr double shear_modulus = 0.3, relaxation_s = 100;
constexpr double length = 60, width = 20, height = 30;

// Pull over the section at rest, in units of mu, of a stretch l that is held from time 0, at time t in units of tau:
// l/c - sqrt(c)/l^2, where c = C_p along the strip and dc/dt = l^2 - (l^2 + 2 c^(3/2)/l)/3.
double expected_pull(double l, double t) {
  const auto rate = [&](double c) { return (2 * l * l - 2 * std::pow(c, 1.5) / l) / 3; };
  const int steps = 10000;
  const double h = t / steps;
  double c = 1;
  for (int k = 0; k < steps; ++k) {
    const double a = rate(c), b = rate(c + h / 2 * a), d = rate(c + h / 2 * b), e = rate(c + h * d);
    c += h / 6 * (a + 2 * b + 2 * d + e);
  }
  return l / c - std::sqrt(c) / (l * l);
}

struct Pulls {
  double at_once, after_tau;
};

Pulls pulls_of_strip(double stretch, int steps) {
  Model model(build_block({.length_um = length, .width_um = width, .cell_height_um = height, .cells = {3, 1, 1}}));
  const std::vector<double> moduli(3, shear_modulus), relaxation(3, relaxation_s);
  model.laws.push_back(std::make_unique<NeoHookean>(model.tissue, moduli, relaxation));
  State state = rest_state(model);
  for (std::size_t n = 0; n < model.tissue.node_count(); ++n) {
    const Vec3& X = model.tissue.rest_positions[n];
    model.held[n] = {std::abs(X.x()) == length / 2, X.y() == -width / 2, X.z() == -height / 2};
    state.positions[n].x() *= stretch;
    for (const int axis : {1, 2}) {  // to the sides that are held
      const double side = axis == 1 ? -width / 2 : -height / 2;
      state.positions[n][axis] = side + (X[axis] - side) / std::sqrt(stretch);
    }
  }
  NewtonStepper stepper(model, {}, LinearMethod::direct, TimeOrder::second);
  const auto step = [&](double duration_s) {
    State next;
    const StepReport report = stepper.advance(state, duration_s, true, next);
    EXPECT_TRUE(report.converged()) << report.reason();
    // Without drag what is not balanced at the end is what holds it.
    Step end{next.positions, state.positions, state.velocities, duration_s, next.time_s};
    if (state.trend.step_s > 0) {
      const BackwardDifference rates = backward_difference(duration_s, state.trend.step_s);
      end.rate_s = rates.rate_s;
      end.ahead = rates.ahead;
    }
    end.internal = state.internals[0];
    Vectors forces(next.positions.size(), Vec3::Zero());
    model.laws[0]->add_forces(end, forces);
    model.volumes.add_forces(next.positions, next.multipliers, forces);
    double pull = 0;
    for (std::size_t n = 0; n < forces.size(); ++n)
      if (model.tissue.rest_positions[n].x() == length / 2) pull -= forces[n].x();
    state = std::move(next);
    return pull / (width * height * shear_modulus);
  };
  Pulls pulls{step(1e-7), 0};
  state.trend = {};  // what came before says nothing of a step of another length
  for (int k = 0; k < steps; ++k) pulls.after_tau = step(relaxation_s / steps);
  return pulls;
}

TEST(MaxwellStrip, PullDecays) {
  int cases = 0;
  for (const double stretch : {1.001, 1.8, 0.5}) {
    const Pulls pulls = pulls_of_strip(stretch, 100);
    const double at_once = expected_pull(stretch, 1e-12), after_tau = expected_pull(stretch, 1);
    std::printf(
        "strip held at %.3f: pull over mu %.5f at once, %.5f after tau (expected %.5f, %.5f); %.4f of it left\n",
        stretch, pulls.at_once, pulls.after_tau, at_once, after_tau, pulls.after_tau / pulls.at_once);
    EXPECT_NEAR(pulls.at_once / at_once, 1, 1e-5);
    EXPECT_NEAR(pulls.after_tau / after_tau, 1, 2e-3);
    if (stretch == 1.001) {
      EXPECT_NEAR(pulls.after_tau / pulls.at_once, std::exp(-1.0), 2e-3);
    }
    ++cases;
  }
  RecordProperty("cases", cases);
}

}  // namespace
}  // namespace plica
