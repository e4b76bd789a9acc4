#include "simulation/step_length.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

/// A state of one node with a velocity.
State moving(double time_s, const Vec3& velocity) {
  State state;
  state.time_s = time_s;
  state.positions = {Vec3::Zero()};
  state.velocities = {velocity};
  return state;
}

TEST(StepLength, FixedStepsStayOnTheirGridAndEndOnTime) {
  RunControls controls;
  controls.fixed_step_s = 0.3;
  controls.end_s = 1;
  const StepLength length(controls);
  EXPECT_DOUBLE_EQ(length.propose(0), 0.3);
  EXPECT_NEAR(length.propose(0.6), 0.3, 1e-12);
  EXPECT_NEAR(length.propose(0.9), 0.1, 1e-12);
  EXPECT_NEAR(length.propose(0.45), 0.15, 1e-12);  // back to the grid after a halved step
}

TEST(StepLength, AFailedStepIsHalvedUntilItIsNotWorthIt) {
  RunControls controls;
  controls.fixed_step_s = 1;
  StepLength length(controls);
  double tried = length.propose(0);
  int halvings = 0;
  while (length.halve(tried)) {
    const double next = length.propose(0);
    EXPECT_NEAR(next, tried / 2, 1e-12);
    tried = next;
    ASSERT_LT(++halvings, 100);
  }
  EXPECT_GT(halvings, 10);
}

TEST(StepLength, AdaptiveStepsLandOnFrames) {
  RunControls controls;
  controls.first_step_s = 4;
  controls.frame_every_s = 15;
  const StepLength length(controls);
  double time = 0;
  int steps = 0;
  while (time < 15 - 1e-9) {
    const double step = length.propose(time);
    EXPECT_LE(step, 4 * (1 + 1e-9));
    time += step;
    ASSERT_LT(++steps, 10);
  }
  EXPECT_NEAR(time, 15, 1e-12);
}

// Half h^2 x'' with x'' from the change of velocity between the middles of two steps: for a constant acceleration a and
// equal steps the error is h^2 a / 2.
TEST(StepLength, RejectsAStepWhoseErrorIsFarTooLarge) {
  RunControls controls;
  controls.first_step_s = 1;
  controls.position_tolerance_um = 0.01;
  controls.frame_every_s = 0;
  const Vec3 velocity(1, 0, 0);
  StepLength length(controls);
  EXPECT_TRUE(length.accept(moving(0, Vec3::Zero()), moving(1, velocity), 1)) << "nothing is known on the first step";
  EXPECT_FALSE(length.accept(moving(1, velocity), moving(2, 2 * velocity), 1));
  EXPECT_LT(length.propose(1), 0.5);
}

TEST(StepLength, GrowsWhileStepsAreAccurateUpToItsLimit) {
  RunControls controls;
  controls.first_step_s = 1;
  controls.max_step_s = 5;
  controls.frame_every_s = 0;
  StepLength length(controls);
  const State steady = moving(0, Vec3(1, 0, 0));
  double step = length.propose(0), time = 0;
  for (int k = 0; k < 10; ++k) {
    EXPECT_TRUE(length.accept(steady, steady, step));
    time += step;
    const double next = length.propose(time);
    EXPECT_GE(next, step);
    EXPECT_LE(next, 5);
    step = next;
  }
  EXPECT_DOUBLE_EQ(step, 5);
}

// The step that keeps the error at the tolerance: acceleration a, h^2 a / 2 = tolerance.
TEST(StepLength, SettlesWhereTheErrorIsNearTheTolerance) {
  RunControls controls;
  controls.first_step_s = 0.01;
  controls.position_tolerance_um = 0.01;
  controls.frame_every_s = 0;
  StepLength length(controls);
  const double acceleration = 0.5;
  double time = 0, step = 0, before_from = -0.01;
  for (int k = 0; k < 40; ++k) {
    step = length.propose(time);
    // Backward Euler's velocity is the mean over the step.
    const auto velocity = [&](double from, double to) { return Vec3(acceleration * (from + to) / 2, 0, 0); };
    if (length.accept(moving(time, velocity(before_from, time)), moving(time + step, velocity(time, time + step)),
                      step)) {
      before_from = time;
      time += step;
    }
  }
  const double ideal = std::sqrt(2 * controls.position_tolerance_um / acceleration);
  EXPECT_GT(step, 0.7 * ideal);
  EXPECT_LT(step, 1.1 * ideal);
}

}  // namespace
}  // namespace plica
