// Second-order velocities at the end of a step from it and the previous one (BDF2 with variable steps), and step error
// estimates. Theory: docs/theory/step.md.
#pragma once

#include <optional>

#include "mechanics/model.hpp"

namespace plica {

/// Order in time: backward Euler, or second-order backward differences.
enum class TimeOrder { first, second };

/// Discretisation of rates at the end of a step: `rate_s` and `ahead` of Step.
struct BackwardDifference {
  double rate_s;
  double ahead;
};

/// Return the second-order formula for a step of `step_s` > 0 after one of `last_s` > 0.
BackwardDifference backward_difference(double step_s, double last_s);

/// Return the possible order of a step from `before`: second order is zero-stable only up to 1 + sqrt 2 times the last
/// step.
TimeOrder possible_order(const State& before, double step_s);

/// Return the formula used in the step from `before` to `after`.
BackwardDifference rates_of(const State& before, const State& after);

/// Return node positions at the beginning of the step that led to `state`, um.
Vectors earlier_positions(const State& state);

/// Return mean velocities over the last step, um/s; nodes.
const Vectors& mean_velocities(const State& state);

/// Set velocities and trend of `after`, whose positions and multipliers are known, after a step of this length and
/// order.
void record_motion(const State& before, double step_s, TimeOrder order, State& after);

/// Largest nodal error of a step and the order of its estimate: proportional to the square or cube of the step.
struct StepError {
  double um;
  TimeOrder order;
};

/// Estimate the error of the step from `before` to `after` by the change of velocities. Empty for a first step.
std::optional<StepError> step_error(const State& before, const State& after);

}  // namespace plica
