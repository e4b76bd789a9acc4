#include "simulation/step_length.hpp"

#include <algorithm>
#include <cmath>

namespace plica {
namespace {

// The first multiple of `period` after `time`, by more than rounding.
double next_multiple(double time, double period) {
  return (std::floor(time / period * (1 + 1e-12) + 1e-9) + 1) * period;
}

}  // namespace

StepLength::StepLength(const RunControls& controls, double wanted_s)
    : wanted_s_(controls.fixed_step_s.value_or(wanted_s > 0 ? wanted_s : controls.first_step_s)) {}

double StepLength::propose(const RunControls& controls, double time_s, double until_s) const {
  double stop = std::min(controls.end_s, until_s);
  if (controls.fixed_step_s) {
    // On the grid of the given step, also after a step that had to be halved.
    stop = std::min(stop, next_multiple(time_s, *controls.fixed_step_s));
  } else {
    if (controls.frame_every_s > 0) stop = std::min(stop, next_multiple(time_s, controls.frame_every_s));
    for (const double point : controls.program_points_s)
      if (point > time_s * (1 + 1e-12)) stop = std::min(stop, point);
  }
  const double left = stop - time_s;
  if (controls.fixed_step_s) return std::min(wanted_s_, left);
  // Even steps to the next stop rather than long ones and a crumb; one a quarter longer than wanted if that saves one.
  // To second order a step that much longer than twice the last would be too long for it (possible_order).
  const double stretch = controls.scheme.order == TimeOrder::first ? 1.25 : 1.2;
  const double steps = std::ceil(left / wanted_s_ * (1 - 1e-12));
  if (steps == 2 && left <= std::min(stretch * wanted_s_, controls.max_step_s)) return left;
  return steps <= 3 ? left / steps : wanted_s_;
}

bool StepLength::accept(const RunControls& controls, const State& before, const State& after) {
  const double duration_s = after.trend.step_s;
  if (controls.fixed_step_s) {
    wanted_s_ = *controls.fixed_step_s;
    return true;
  }
  const std::optional<StepError> error = step_error(before, after);
  if (!error) {
    wanted_s_ = duration_s;
    return true;
  }
  const double allowed = controls.position_tolerance_um / std::max(error->um, 1e-300);
  const double factor = 0.9 * (error->order == TimeOrder::first ? std::sqrt(allowed) : std::cbrt(allowed));
  if (factor < 0.6) {
    wanted_s_ = duration_s * std::max(factor, 0.2);
    return false;
  }
  wanted_s_ = std::min(controls.max_step_s, std::max(duration_s * std::clamp(factor, 0.5, 2.0), 1e-9));
  return true;
}

bool StepLength::halve(const RunControls& controls, double failed_s) {
  wanted_s_ = 0.5 * failed_s;
  return wanted_s_ > 1e-4 * std::max(controls.first_step_s, controls.fixed_step_s.value_or(0));
}

}  // namespace plica
