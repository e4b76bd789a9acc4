#include "solver/projection/linearly_implicit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "solver/step/newton_stepper.hpp"
#include "support/law_checks.hpp"
#include "support/models.hpp"

namespace plica {
namespace {

using namespace support;

/// Some steps; every one has to converge.
State steps(Stepper& stepper, State state, double duration_s, int count) {
  State next;
  for (int k = 0; k < count; ++k) {
    const StepReport report = stepper.advance(state, duration_s, k == 0, next);
    EXPECT_TRUE(report.converged()) << report.reason() << " in step " << k;
    if (!report.converged()) break;
    std::swap(state, next);
  }
  return state;
}

double distance(const State& a, const State& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.positions.size(); ++n) most = std::max(most, (a.positions[n] - b.positions[n]).norm());
  return most;
}

/// A sheet without volumes or shell, some of it held; and where it is after a while of contraction.
Model held_sheet() {
  Model model = dimpling_sheet();
  model.volumes.hold(false);
  for (std::size_t n = 0; n < model.held.size(); n += 5) model.held[n] = {true, n % 2 == 0, false};
  return model;
}

// The step is A dx = f: conjugate gradients against a dense factor of the assembled tangents.
TEST(LinearlyImplicit, ConjugateGradientsAgreeWithADirectSolve) {
  const Model model = held_sheet();
  LinearlyImplicit rough(model, 1e-8, 1000);
  const State state = steps(rough, rest_state(model), 5, 3);
  const double duration_s = 7;
  Step step{state.positions, state.positions, state.velocities, duration_s, state.time_s + duration_s};
  step.semidefinite_tangent = true;
  const Eigen::Index size = 3 * static_cast<Eigen::Index>(state.positions.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(size, size);
  Vectors forces(state.positions.size(), Vec3::Zero());
  for (const auto& law : model.laws) {
    A += DenseTangent(*law, step).matrix;
    law->add_forces(step, forces);
  }
  Eigen::VectorXd f = flat(forces);
  for (Eigen::Index i = 0; i < size; ++i)
    if (model.held[i / 3][i % 3]) {
      A.row(i).setZero();
      A.col(i).setZero();
      A(i, i) = 1;
      f[i] = 0;
    }
  ASSERT_EQ(A.llt().info(), Eigen::Success) << "not positive definite";
  const Eigen::VectorXd direct = A.llt().solve(f);
  int cases = 0;
  for (const double tolerance : {1e-4, 1e-8, 1e-12}) {
    State next;
    const StepReport report = LinearlyImplicit(model, tolerance, 1000).advance(state, duration_s, false, next);
    ASSERT_TRUE(report.converged());
    EXPECT_LE(report.residual, tolerance);
    Vectors moved(next.positions.size());
    for (std::size_t n = 0; n < moved.size(); ++n) moved[n] = next.positions[n] - state.positions[n];
    EXPECT_LE((A * flat(moved) - f).norm(), (tolerance + 1e-12) * 1.1 * f.norm());
    const double off = (flat(moved) - direct).norm() / direct.norm();
    std::printf("tolerance %.0e: %d iterations, %.1e off the direct solve\n", tolerance, report.linear_solves, off);
    EXPECT_LE(off, 100 * tolerance + 1e-10);
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

// Both are first-order methods for the same motion: their difference halves with the step.
TEST(LinearlyImplicit, ComesToNewtonsMotionAtFirstOrderInTheStep) {
  const Model model = held_sheet();
  const double time_s = 8;
  NewtonStepper newton(model);
  const State exact = steps(newton, rest_state(model), time_s / 512, 512);
  double previous = 0, previous_difference = 0;
  int cases = 0;
  for (const int count : {16, 32, 64}) {
    LinearlyImplicit linear(model, 1e-10, 1000);
    NewtonStepper nonlinear(model);
    const State end = steps(linear, rest_state(model), time_s / count, count);
    const double error = distance(end, exact),
                 difference = distance(end, steps(nonlinear, rest_state(model), time_s / count, count));
    std::printf("%3d steps: %.4f um off the limit, %.4f um off Newton's steps", count, error, difference);
    if (previous > 0)
      std::printf(", orders %.2f %.2f", std::log2(previous / error), std::log2(previous_difference / difference));
    std::printf("\n");
    if (count == 64) {
      EXPECT_NEAR(std::log2(previous_difference / difference), 1, 0.15);
      EXPECT_NEAR(std::log2(previous / error), 1, 0.3);
    }
    previous = error;
    previous_difference = difference;
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

TEST(LinearlyImplicit, HeldDirectionsStayAndRestStaysAtRest) {
  const Model model = held_sheet();
  LinearlyImplicit stepper(model, 1e-6, 1000);
  const State end = steps(stepper, rest_state(model), 5, 4);
  for (std::size_t n = 0; n < model.held.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model.held[n][axis]) {
        EXPECT_EQ(end.positions[n][axis], model.tissue.rest_positions[n][axis]);
      }
  Model idle(build_block({.cells = {2, 2, 1}}));
  add_elasticity(idle);
  add_drag(idle);
  LinearlyImplicit on_idle(idle, 1e-6, 1000);
  EXPECT_LE(distance(steps(on_idle, rest_state(idle), 10, 1), rest_state(idle)), 1e-10);
}

// The active force is that of the step's end, as in Newton's step.
TEST(LinearlyImplicit, ContractionIsThatOfTheEndOfTheStep) {
  const double duration_s = 2;
  Vectors ends[2];
  for (const bool ramp : {false, true}) {
    Model model(build_block({.length_um = 40, .width_um = 20, .cell_height_um = 40, .cells = {2, 1, 1}}));
    add_elasticity(model);
    add_contraction(model, {true, false}, {.stiffness = 3}, ramp ? Program({0, duration_s}, {0, 1}) : Program{});
    add_drag(model);
    LinearlyImplicit stepper(model, 1e-10, 1000);
    ends[ramp] = steps(stepper, rest_state(model), duration_s, 1).positions;
    EXPECT_GT((ends[ramp].front() - model.tissue.rest_positions.front()).norm(), 1e-3);
  }
  EXPECT_EQ(ends[0], ends[1]);
}

TEST(LinearlyImplicit, FailuresAreReportedAndLeaveTheStateAlone) {
  const Model model = held_sheet();
  State next;
  next.time_s = 77;
  EXPECT_EQ(LinearlyImplicit(model, 1e-12, 2).advance(rest_state(model), 5, true, next).status,
            StepReport::Status::no_linear_convergence);
  State lost = rest_state(model);
  lost.positions[3].x() = NAN;
  EXPECT_EQ(LinearlyImplicit(model, 1e-6, 100).advance(lost, 5, true, next).status, StepReport::Status::not_finite);
  LinearlyImplicit interrupted(model, 1e-6, 100);
  interrupted.stop_when([] { return true; });
  EXPECT_EQ(interrupted.advance(rest_state(model), 5, true, next).status, StepReport::Status::interrupted);
  EXPECT_EQ(next.time_s, 77);
  EXPECT_TRUE(next.positions.empty());
}

}  // namespace
}  // namespace plica
