// Linear and angular momentum of a free body.
#include <gtest/gtest.h>

#include <cstdio>

#include "mechanics/active/contraction.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/surroundings.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"

namespace plica {
namespace {

using namespace support;

// Waves cross the body of 60 um in about 0.6 s at this density (E = 1 kPa, mass in g).
constexpr double density = 1e-4;

Model free_body() {
  Model model(distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 2}}, 1, 1));
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.45);
  model.laws.push_back(std::make_unique<Corotational>(model.tissue, moduli, 0));
  model.laws.push_back(std::make_unique<Dilatation>(model.tissue, moduli.bulk_modulus()));
  ContractionRule rule{.stiffness = 1, .preload = 2, .damping = 0.1};
  model.laws.push_back(std::make_unique<Contraction>(
      contraction_springs(model.tissue, CellSet(model.tissue.cells.size(), true), rule), Program{}));
  model.laws.push_back(std::make_unique<Inertia>(model.tissue, density));
  return model;
}

/// Moving, turning and trembling.
State thrown(const Model& model) {
  State state = rest_state(model);
  Random random(2);
  for (std::size_t n = 0; n < state.velocities.size(); ++n)
    state.velocities[n] = Vec3(5, -3, 2) + Vec3(0.3, 0.2, 1).cross(state.positions[n]) + random.vector(2);
  return state;
}

struct Momenta {
  Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
};

Momenta momenta(const Model& model, const State& state) {
  const Inertia inertia(model.tissue, density);
  Momenta sum;
  for (std::size_t n = 0; n < state.positions.size(); ++n) {
    const Vec3 p = inertia.masses()[n] * state.velocities[n];
    sum.linear += p;
    sum.angular += state.positions[n].cross(p);
  }
  return sum;
}

State throw_for(const Model& model, double time_s, int steps, double& worst_linear) {
  StepTolerances tolerances;
  tolerances.force = 1e-10;  // what a step leaves unbalanced moves the body as a whole
  NewtonStepper solver(model, tolerances);
  State state = thrown(model), next;
  const Momenta before = momenta(model, state);
  for (int k = 0; k < steps; ++k) {
    const StepReport report = solver.advance(state, time_s / steps, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    std::swap(state, next);
    worst_linear = std::max(worst_linear, (momenta(model, state).linear - before.linear).norm() / before.linear.norm());
  }
  return state;
}

TEST(Momentum, LinearMomentumOfAFreeBodyIsConstant) {
  const Model model = free_body();
  double worst = 0;
  throw_for(model, 1, 20, worst);
  std::printf("free body, 20 steps: linear momentum changes by %.1e\n", worst);
  EXPECT_LE(worst, 1e-12);
}

// Backward Euler loses angular momentum, at first order in the step; the forces themselves do not (the next test).
TEST(Momentum, AngularMomentumDriftsAtFirstOrderInTheStep) {
  const Model model = free_body();
  const Vec3 before = momenta(model, thrown(model)).angular;
  double previous = 0, ignored = 0;
  int cases = 0;
  for (const int steps : {40, 80, 160, 320}) {
    const double drift =
        (momenta(model, throw_for(model, 0.5, steps, ignored)).angular - before).norm() / before.norm();
    std::printf("free body, 0.5 s in %3d steps: angular momentum drifts by %.3e", steps, drift);
    if (previous > 0) {
      std::printf(", order %.2f", std::log2(previous / drift));
    }
    std::printf("\n");
    if (steps == 320) {
      EXPECT_NEAR(std::log2(previous / drift), 1, 0.15);
    }
    previous = drift;
    ++cases;
  }
  RecordProperty("cases", cases);
}

TEST(Momentum, InternalForcesHaveNoResultantAndNoTorque) {
  const Model model = free_body();
  double worst_resultant = 0, worst_torque = 0;
  int cases = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Motion motion = random_motion(model.tissue, 3, seed);
    Vectors forces(model.tissue.node_count(), Vec3::Zero());
    for (const auto& law : model.laws)
      if (law->name() != "inertia") law->add_forces(motion.step(), forces);
    Random random(seed);
    std::vector<double> pressures;
    for (std::size_t c = 0; c < model.volumes.count(); ++c) pressures.push_back(random.number(1));
    model.volumes.add_forces(motion.positions, pressures, forces);
    worst_resultant = std::max(worst_resultant, resultant(forces).norm() / largest(forces));
    worst_torque = std::max(worst_torque, torque(forces, motion.positions).norm() / (largest(forces) * 100));
    ++cases;
  }
  std::printf("internal forces: resultant %.1e, torque %.1e of the largest force (arm 100 um) in %d motions\n",
              worst_resultant, worst_torque, cases);
  EXPECT_LE(worst_resultant, 1e-12);
  EXPECT_LE(worst_torque, 1e-12);
}

}  // namespace
}  // namespace plica
