#include "solver/projection/projected_stepper.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "core/threads.hpp"
#include "solver/make_stepper.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;
using Weights = ProjectionRule::Weights;
using Forces = StepScheme::Forces;

StepScheme scheme(Forces forces, Weights weights = Weights::equal) {
  return {.forces = forces, .linear_tolerance = 1e-10, .projection = ProjectionRule{.weights = weights}};
}

constexpr double slow = 1e-6;  // um/s; what is left of the way then is about 40 s of it

/// Steps until nothing moves any more, at most `most`.
State come_to_rest(Stepper& stepper, State state, double duration_s, int most) {
  State next;
  for (int k = 0; k < most; ++k) {
    const StepReport report = stepper.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    std::swap(state, next);
    if (k > 0 && largest(state.velocities) < slow) return state;
  }
  ADD_FAILURE() << "still moving at " << largest(state.velocities) << " um/s";
  return state;
}

/// The dimpling sheet standing on its four corner nodes: a free one would swim (of weights that are not the drag's the
/// resultant is not zero).
Model sheet(bool volumes_are_held) {
  Model model = dimpling_sheet();
  for (std::size_t n = 0; n < model.held.size(); ++n) {
    const Vec3& x = model.tissue.rest_positions[n];
    if (std::abs(x.x()) > 29 && std::abs(x.y()) > 29 && x.z() < model.tissue.rest_positions[0].z() + 1)
      model.held[n] = {true, true, true};
  }
  model.volumes.hold(volumes_are_held);
  return model;
}

/// Forces of the laws without motion, nN.
Vectors still_forces(const Model& model, const State& state) {
  Vectors forces(state.positions.size(), Vec3::Zero());
  const Step still{state.positions, state.positions, state.velocities, 1, state.time_s};
  for (const auto& law : model.laws) law->add_forces(still, forces);
  return forces;
}

/// Nodes' drag and, where weights are equal, its mean, nN s/um.
Vectors drags(const Model& model) {
  Vectors drag(model.tissue.node_count(), Vec3::Zero());
  const Vectors& x = model.tissue.rest_positions;
  SurfaceDrag(model.tissue, usual_drag).add_tangent_product({x, x, x, 1, 0}, Vectors(drag.size(), Vec3::Ones()), drag);
  return drag;
}

// Where a splitting rests: f(x) + (D + h K) W J^T p = 0 to first order in h, W the projection's weights; and not where
// forces balance, f(x) + J^T p = 0 (docs/theory/paper_algorithm.md).
TEST(ProjectedStepper, RestsWhereTheoryHasIt) {
  const Model model = sheet(false);
  const Vectors drag = drags(model);
  double mean_drag = 0;
  for (const Vec3& d : drag) mean_drag += d.x() / static_cast<double>(drag.size());
  int cases = 0;
  for (const Weights weights : {Weights::equal, Weights::mobility}) {
    double previous = 0;
    for (const double h : {0.4, 0.2}) {
      const auto stepper = make_stepper(model, scheme(Forces::linearly_implicit, weights));
      const State rest = come_to_rest(*stepper, rest_state(model), h, 4000);
      // W J^T p, and with it both balances.
      Vectors pushed(rest.positions.size(), Vec3::Zero()), balance = still_forces(model, rest);
      model.volumes.add_forces(rest.positions, rest.multipliers, pushed);
      const double size = largest(balance);
      Vectors plain = balance;
      for (std::size_t n = 0; n < plain.size(); ++n) plain[n] += pushed[n];
      if (weights == Weights::mobility)
        for (std::size_t n = 0; n < pushed.size(); ++n) pushed[n] /= drag[n].x();
      else
        for (Vec3& push : pushed) push /= mean_drag;
      Step step{rest.positions, rest.positions, rest.velocities, h, rest.time_s};
      step.semidefinite_tangent = true;
      for (std::size_t n = 0; n < pushed.size(); ++n) pushed[n] = model.held[n][0] ? Vec3(Vec3::Zero()) : h * pushed[n];
      for (const auto& law : model.laws) law->add_tangent_product(step, pushed, balance);
      for (std::size_t n = 0; n < balance.size(); ++n)
        if (model.held[n][0]) balance[n] = plain[n] = Vec3::Zero();
      const double of_theory = largest(balance) / size, of_forces = largest(plain) / size;
      std::printf("%s weights, h = %.2f s: %.1e off the predicted balance, %.1e off that of forces\n",
                  weights == Weights::equal ? "equal" : "mobility", h, of_theory, of_forces);
      EXPECT_LE(of_theory, 0.02);
      if (previous > 0) {
        EXPECT_LE(of_theory, 0.7 * previous);
      }
      previous = of_theory;
      EXPECT_GT(of_forces, 3 * of_theory);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 4);
}

// With the weights that belong to the drag the splitting comes to the coupled solve as the step gets short; with equal
// ones it goes elsewhere.
TEST(ProjectedStepper, ByMobilityComesToTheCoupledSolve) {
  const Model split = sheet(false), whole = sheet(true);
  StepScheme coupled_scheme;
  const auto coupled = make_stepper(whole, coupled_scheme);
  const State expected = come_to_rest(*coupled, rest_state(whole), 5, 2000);
  const auto off_coupled = [&](const StepScheme& of, double h) {
    State start = expected;  // from nearby: where it rests does not depend on the way
    std::fill(start.velocities.begin(), start.velocities.end(), Vec3::Zero());
    const State rest = come_to_rest(*make_stepper(split, of), start, h, 12000);
    double off = 0;
    for (std::size_t n = 0; n < rest.positions.size(); ++n)
      off = std::max(off, (rest.positions[n] - expected.positions[n]).norm());
    return off;
  };
  int cases = 0;
  for (const Forces forces : {Forces::newton, Forces::linearly_implicit}) {
    double previous = 0, previous_order = 0.4;
    for (const double h : {0.2, 0.1, 0.05}) {
      const double off = off_coupled(scheme(forces, Weights::mobility), h);
      std::printf("%s, h = %.2f s: rests %.4f um off the coupled solve", forces == Forces::newton ? "Newton" : "linear",
                  h, off);
      if (previous > 0) std::printf(", order %.2f", std::log2(previous / off));
      std::printf("\n");
      // The order comes up to 1 from below: a cell's stiffness over its drag is 10/s, so h = 0.05 s is not yet short.
      if (previous > 0) {
        EXPECT_GT(std::log2(previous / off), previous_order + 0.05);
        previous_order = std::log2(previous / off);
      }
      previous = off;
      ++cases;
    }
    const double equal = off_coupled(scheme(forces, Weights::equal), 0.05);
    std::printf("the same with equal weights: %.4f um\n", equal);
    EXPECT_LT(previous, 0.05);
    EXPECT_GT(equal, 4 * previous);
  }
  EXPECT_EQ(cases, 6);
}

TEST(ProjectedStepper, EveryStepKeepsVolumesAndShell) {
  Model model = furrowing_sphere();
  model.volumes.hold(false);
  int cases = 0;
  for (const Forces forces : {Forces::newton, Forces::linearly_implicit}) {
    const auto stepper = make_stepper(model, scheme(forces));
    State state = rest_state(model), next;
    for (int k = 0; k < 4; ++k) {
      const StepReport report = stepper->advance(state, 5, k == 0, next);
      ASSERT_TRUE(report.converged()) << report.reason();
      EXPECT_GT(report.cubics, 0);
      EXPECT_LE(report.constraint_error, 1e-9);
      for (const double error : model.volumes.relative_errors(next.positions)) EXPECT_LE(std::abs(error), 1e-9);
      for (const NodeId node : model.obstacles.front()->nodes())
        EXPECT_GE(model.obstacles.front()->gap(next.positions[node.index()]).value, -1e-6);
      for (std::size_t n = 0; n < next.positions.size(); ++n)
        EXPECT_LE((next.velocities[n] - (next.positions[n] - state.positions[n]) / 5).norm(), 1e-12);
      std::swap(state, next);
      ++cases;
    }
  }
  EXPECT_EQ(cases, 8);
}

TEST(ProjectedStepper, OneAndTwoThreadsGiveTheSameBits) {
  Model model = furrowing_sphere();
  model.volumes.hold(false);
  int cases = 0;
  for (const Forces forces : {Forces::newton, Forces::linearly_implicit}) {
    std::vector<State> ends;
    for (const int count : {1, 2}) {
      const ThreadCount scope(count);
      const auto stepper = make_stepper(model, scheme(forces));
      State state = rest_state(model), next;
      for (int k = 0; k < 3; ++k) {
        ASSERT_TRUE(stepper->advance(state, 3, k == 0, next).converged());
        std::swap(state, next);
      }
      ends.push_back(state);
    }
    EXPECT_EQ(ends[0].positions, ends[1].positions);
    EXPECT_EQ(ends[0].multipliers, ends[1].multipliers);
    EXPECT_EQ(ends[0].contact_forces, ends[1].contact_forces);
    ++cases;
  }
  EXPECT_EQ(cases, 2);
}

// What a resumed run rests on: nothing is remembered but the State.
TEST(ProjectedStepper, AStepDoesNotDependOnTheOnesBefore) {
  const Model model = sheet(false);
  const auto used = make_stepper(model, scheme(Forces::linearly_implicit)),
             fresh = make_stepper(model, scheme(Forces::linearly_implicit));
  State state = rest_state(model), next, a, b;
  for (int k = 0; k < 3; ++k) {
    ASSERT_TRUE(used->advance(state, 2, k == 0, next).converged());
    std::swap(state, next);
  }
  ASSERT_TRUE(used->advance(state, 2, false, a).converged());
  ASSERT_TRUE(fresh->advance(state, 2, false, b).converged());
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.multipliers, b.multipliers);
}

TEST(ProjectedStepper, FailuresLeaveTheStateAlone) {
  Model model = sheet(false);
  StepScheme impatient = scheme(Forces::linearly_implicit);
  impatient.projection->most_sweeps = 1;
  State next;
  next.time_s = 77;
  const StepReport report = make_stepper(model, impatient)->advance(rest_state(model), 20, true, next);
  EXPECT_EQ(report.status, StepReport::Status::not_projected);
  EXPECT_TRUE(report.cell);
  const auto interrupted = make_stepper(model, scheme(Forces::newton));
  interrupted->stop_when([] { return true; });
  EXPECT_EQ(interrupted->advance(rest_state(model), 2, true, next).status, StepReport::Status::interrupted);
  EXPECT_EQ(next.time_s, 77);
  EXPECT_TRUE(next.positions.empty());
}

}  // namespace
}  // namespace plica
