#include "solver/step/backward_difference.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace plica {

BackwardDifference backward_difference(double step_s, double last_s) {
  const double whole = last_s + 2 * step_s;
  return {step_s * ((last_s + step_s) / whole), step_s / last_s * (step_s / whole)};
}

TimeOrder possible_order(const State& before, double step_s) {
  constexpr double most_growth = 2.41;
  return step_s <= most_growth * before.trend.step_s ? TimeOrder::second : TimeOrder::first;
}

BackwardDifference rates_of(const State& before, const State& after) {
  const bool of_second_order = !after.trend.mean_velocities.empty();
  if (!of_second_order) return {after.trend.step_s, 0};
  return backward_difference(after.trend.step_s, before.trend.step_s);
}

Vectors earlier_positions(const State& state) {
  Vectors earlier = state.positions;
  const Vectors& velocities = mean_velocities(state);
  parallel_for(earlier.size(), [&](std::size_t n) { earlier[n] -= state.trend.step_s * velocities[n]; });
  return earlier;
}

const Vectors& mean_velocities(const State& state) {
  return state.trend.mean_velocities.empty() ? state.velocities : state.trend.mean_velocities;
}

void record_motion(const State& before, double step_s, TimeOrder order, State& after) {
  const std::size_t nodes = after.positions.size();
  const double last_s = before.trend.step_s;
  after.trend = {
      .step_s = step_s, .earlier_s = last_s, .mean_velocities = {}, .accelerations = {}, .multiplier_rates = {}};
  after.velocities.resize(nodes);
  parallel_for(nodes,
               [&](std::size_t n) { after.velocities[n] = (after.positions[n] - before.positions[n]) / step_s; });
  if (last_s == 0) return;

  const Vectors& last = mean_velocities(before);
  after.trend.accelerations.resize(nodes);
  const double apart_s = 0.5 * (last_s + step_s);
  parallel_for(nodes, [&](std::size_t n) { after.trend.accelerations[n] = (after.velocities[n] - last[n]) / apart_s; });
  after.trend.multiplier_rates.resize(after.multipliers.size());
  for (std::size_t m = 0; m < after.multipliers.size(); ++m)
    after.trend.multiplier_rates[m] = (after.multipliers[m] - before.multipliers[m]) / step_s;
  if (order == TimeOrder::first) return;

  after.trend.mean_velocities = after.velocities;
  parallel_for(nodes, [&](std::size_t n) { after.velocities[n] += 0.5 * step_s * after.trend.accelerations[n]; });
}

std::optional<StepError> step_error(const State& before, const State& after) {
  const Vectors &now = after.trend.accelerations, &last = before.trend.accelerations;
  if (now.empty()) return std::nullopt;
  const double h = after.trend.step_s, last_s = before.trend.step_s;
  // Without a third difference the error of first order will do: a step of second order has a smaller one.
  const bool of_second_order = !after.trend.mean_velocities.empty();
  const bool third = of_second_order && !last.empty();
  double change = 0;
  for (std::size_t n = 0; n < now.size(); ++n)
    change = std::max(change, third ? (now[n] - last[n]).norm() : now[n].norm());
  if (!third) return StepError{0.5 * h * h * change, TimeOrder::first};
  const double rate_s = backward_difference(h, last_s).rate_s;
  return StepError{0.5 * rate_s * h * (last_s + h) * change / (before.trend.earlier_s + last_s + h), TimeOrder::second};
}

}  // namespace plica
