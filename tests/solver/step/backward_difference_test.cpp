#include "solver/step/backward_difference.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace plica {
namespace {

using Motion = std::function<Vec3(double)>;

/// States of one node on its way at the ends of steps of these lengths.
std::vector<State> states_of(const Motion& at, const std::vector<double>& steps_s, TimeOrder order) {
  State state;
  state.positions = {at(0)};
  state.velocities = {Vec3::Zero()};
  std::vector<State> states = {state};
  for (const double step_s : steps_s) {
    State next = states.back();
    next.time_s += step_s;
    next.positions = {at(next.time_s)};
    record_motion(states.back(), step_s, std::min(order, possible_order(states.back(), step_s)), next);
    states.push_back(next);
  }
  return states;
}

Vec3 quadratic(double t) { return {3 - 2 * t, 1 + t * t, t - 0.5 * t * t}; }
Vec3 rate_of_quadratic(double t) { return {-2, 2 * t, 1 - t}; }

TEST(BackwardDifference, VelocitiesOfSecondOrderAreExactForConstantAccelerations) {
  const std::vector<double> steps_s = {0.5, 0.5, 1, 0.1, 0.24, 0.3};
  const auto states = states_of(quadratic, steps_s, TimeOrder::second);
  for (std::size_t k = 2; k < states.size(); ++k) {
    const double time_s = states[k].time_s, step_s = steps_s[k - 1];
    EXPECT_NEAR((states[k].velocities[0] - rate_of_quadratic(time_s)).norm(), 0, 1e-12) << "step " << k;
    EXPECT_NEAR((mean_velocities(states[k])[0] - rate_of_quadratic(time_s - step_s / 2)).norm(), 0, 1e-12);
    EXPECT_NEAR((states[k].trend.accelerations[0] - Vec3(0, 2, -1)).norm(), 0, 1e-12);
  }
}

TEST(BackwardDifference, OfFirstOrderVelocitiesAreMeans) {
  const auto states = states_of(quadratic, {0.5, 1.5}, TimeOrder::first);
  EXPECT_NEAR((states[2].velocities[0] - rate_of_quadratic(1.25)).norm(), 0, 1e-12);
  EXPECT_EQ(mean_velocities(states[2]), states[2].velocities);
}

/// What rates at the end of the step to `after` are reckoned from.
Vec3 before_of(const State& before, const State& earlier, const BackwardDifference& rates) {
  Step step;
  step.previous_positions = before.positions;
  step.earlier_positions = earlier.positions;
  step.ahead = rates.ahead;
  return step.before([](std::span<const Vec3> x) { return x[0]; });
}

// The velocity that laws see in a step is the one that the state has after it.
TEST(BackwardDifference, LawsSeeTheVelocityAtTheEnd) {
  const auto states = states_of([](double t) { return Vec3(std::exp(-t), std::sin(t), t * t * t); },
                                {0.4, 0.7, 0.2, 0.4}, TimeOrder::second);
  for (std::size_t k = 1; k < states.size(); ++k) {
    const State &before = states[k - 1], &after = states[k];
    const BackwardDifference rates = k > 1 ? backward_difference(after.trend.step_s, before.trend.step_s)
                                           : BackwardDifference{after.trend.step_s, 0};
    const Vec3 seen = (after.positions[0] - before_of(before, states[k > 1 ? k - 2 : 0], rates)) / rates.rate_s;
    EXPECT_NEAR((seen - after.velocities[0]).norm(), 0, 1e-12) << "step " << k;
  }
  const BackwardDifference even = backward_difference(3, 3);
  EXPECT_DOUBLE_EQ(even.rate_s, 2);  // 2/3 h, and 4/3 x_n - 1/3 x_(n-1): the constants of every textbook
  EXPECT_DOUBLE_EQ(even.ahead, 1.0 / 3);
}

// One step of x' = g(t), begun from exact values, is off by the estimate: exactly where the third derivative is
// constant (for first order the second).
TEST(BackwardDifference, TheErrorOfAStepIsThatOfTheEquationItSolves) {
  const std::vector<double> steps_s = {0.3, 0.5, 0.4, 0.8};
  const auto error_of_last = [&](const Motion& at, const Motion& rate, TimeOrder order) {
    const auto states = states_of(at, steps_s, order);
    const State &before = states[states.size() - 2], &after = states.back();
    const BackwardDifference rates = order == TimeOrder::second
                                         ? backward_difference(after.trend.step_s, before.trend.step_s)
                                         : BackwardDifference{after.trend.step_s, 0};
    const Vec3 solved = before_of(before, states[states.size() - 3], rates) + rates.rate_s * rate(after.time_s);
    const StepError estimate = step_error(before, after).value();
    EXPECT_EQ(estimate.order, order);
    EXPECT_NEAR(estimate.um, (solved - after.positions[0]).norm(), 1e-12);
    return estimate.um;
  };
  const double first = error_of_last(quadratic, rate_of_quadratic, TimeOrder::first);
  EXPECT_NEAR(first, 0.5 * 0.8 * 0.8 * std::sqrt(5.0), 1e-12);
  const double second = error_of_last([](double t) { return Vec3(t * t * t, 0, 2 * t); },
                                      [](double t) { return Vec3(3 * t * t, 0, 2); }, TimeOrder::second);
  EXPECT_GT(second, 0);
  EXPECT_NEAR(error_of_last(quadratic, rate_of_quadratic, TimeOrder::second), 0, 1e-12);
}

TEST(BackwardDifference, NothingIsKnownOfTheErrorOfAFirstStepAndTooMuchIsSaidOfTheSecond) {
  const auto states = states_of(quadratic, {0.5, 0.5}, TimeOrder::second);
  EXPECT_FALSE(step_error(states[0], states[1]).has_value());
  const StepError second = step_error(states[1], states[2]).value();
  EXPECT_NEAR(second.um, 0.5 * 0.25 * std::sqrt(5.0), 1e-12);
  EXPECT_EQ(second.order, TimeOrder::first);
}

TEST(BackwardDifference, StepsThatGrowTooMuchAreOfFirstOrder) {
  const auto states = states_of(quadratic, {0.5, 0.5}, TimeOrder::second);
  EXPECT_EQ(possible_order(states[0], 0.5), TimeOrder::first) << "nothing is known at the start";
  EXPECT_EQ(possible_order(states[2], 1.2), TimeOrder::second);
  EXPECT_EQ(possible_order(states[2], 0.5 * (1 + std::sqrt(2.0))), TimeOrder::first);
}

}  // namespace
}  // namespace plica
