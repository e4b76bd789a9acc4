// Velocities at the end of a step, to second order, from the step and the one before it (BDF2 on steps of any lengths),
// and the error of a step. Theory: docs/theory/step.md.
#pragma once

#include <optional>

#include "mechanics/model.hpp"

namespace plica {

/// Order in time of a step: backward Euler, or backward differences of second order.
enum class TimeOrder { first, second };

/// How rates at the end of a step are taken: `rate_s` and `ahead` of Step.
struct BackwardDifference {
  double rate_s;
  double ahead;
};

/// Of second order for a step of `step_s` > 0 after one of `last_s` > 0.
BackwardDifference backward_difference(double step_s, double last_s);

/// The order that a step from `before` can have: of second order it is zero-stable only up to 1 + sqrt 2 times the
/// last.
TimeOrder possible_order(const State& before, double step_s);

/// How they were taken in the step that led from `before` to `after`.
BackwardDifference rates_of(const State& before, const State& after);

/// Where nodes were at the beginning of the step that led to `state`, um.
Vectors earlier_positions(const State& state);

/// Mean velocities over the last step, um/s; nodes.
const Vectors& mean_velocities(const State& state);

/// Velocities and trend of `after`, whose positions and multipliers are known, after a step of this length and order.
void record_motion(const State& before, double step_s, TimeOrder order, State& after);

/// The error of a step at the node where it is largest, and the order of its estimate: it goes with the length of the
/// step squared or cubed.
struct StepError {
  double um;
  TimeOrder order;
};

/// Of the step that led from `before` to `after`, by the change of velocities. Nothing is known of it on a first step.
std::optional<StepError> step_error(const State& before, const State& after);

}  // namespace plica
