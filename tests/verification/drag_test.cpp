// A spring under a constant force in a fluid: x(t) = (F/k)(1 - exp(-k t / D)), reached at second order in the step, on
// even steps and on uneven ones, and at any step the BDF2 of it. Rigid rotation of bodies, and momentum.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <functional>

#include "mechanics/active/contraction.hpp"
#include "mechanics/constraints/cell_volume.hpp"
#include "mechanics/elasticity/corotational.hpp"
#include "mechanics/surroundings.hpp"
#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"
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
  model.volumes().hold(false);
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
    }
  }
}

TEST(SpringInFluid, ConvergesToTheExponentialAtSecondOrder) {
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
    }
  }
}

/// Largest nodal force over E A (A: mean face of a cell) after turns by 0 to 360 degrees about an axis.
double worst_force(const Tissue& tissue, const Vec3& axis, int& cases) {
  const ElasticModuli moduli = ElasticModuli::from_young(1, 0.45);
  const Corotational elasticity(tissue, moduli, 0);
  const Dilatation dilatation(tissue, moduli.bulk_modulus());
  const double area = 20 * 20;
  double worst = 0;
  for (int degrees = 0; degrees <= 360; degrees += 15) {
    const Mat3 R = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()).toRotationMatrix();
    Motion motion = at_rest(tissue);
    for (Vec3& x : motion.positions) x = R * x + Vec3(30, -70, 11);
    motion.previous_positions = motion.positions;
    Vectors forces = forces_of(elasticity, motion.step());
    dilatation.add_forces(motion.step(), forces);
    worst = std::max(worst, largest(forces) / area);
    ++cases;
  }
  return worst;
}

TEST(RigidRotation, TurnedBlockHasNoForceAtAnyAngle) {
  const Tissue tissue =
      distorted_block({.length_um = 60, .width_um = 40, .cell_height_um = 40, .cells = {3, 2, 1}}, 2, 1);
  Random random(2);
  std::vector<Vec3> axes = {Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ(), Vec3(1, 1, 0), Vec3(1, -1, 1)};
  for (int k = 0; k < 40; ++k) axes.push_back(random.vector());
  double worst = 0;
  int cases = 0;
  for (const Vec3& axis : axes) worst = std::max(worst, worst_force(tissue, axis, cases));
  std::printf("rigid rotation of a block: largest force %.1e E A in %d turns\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

TEST(RigidRotation, TurnedPillHasNoForceAtAnyAngle) {
  const Tissue tissue = build_shell({});
  double worst = 0;
  int cases = 0;
  for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(1, 2, -3)})
    worst = std::max(worst, worst_force(tissue, axis, cases));
  std::printf("rigid rotation of the pill: largest force %.1e E A in %d turns\n", worst, cases);
  EXPECT_LE(worst, 1e-10);
}

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
  }
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
    for (std::size_t c = 0; c < model.volumes().count(); ++c) pressures.push_back(random.number(1));
    model.volumes().add_forces(motion.positions, pressures, forces);
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
