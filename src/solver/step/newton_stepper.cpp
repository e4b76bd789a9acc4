#include "solver/step/newton_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "solver/linear/node_frame.hpp"
#include "solver/step/balance.hpp"

namespace plica {

/// One attempt at a step: Newton's iterate, and how it got there.
struct NewtonStepper::Attempt {
  Step step;
  Iterate at = {};
  Residual now = {};
  StepReport report = {};
  std::vector<unsigned char> obstacle_changes = {};  // contacts: number of changes
  bool contacts_settled = false;                     // whether the forces of this iterate change no contact
  double residual_reduction = 0;                     // by the last direction
  int slow_iterations = 0;                           // in a row, as in `improve`
};

NewtonStepper::NewtonStepper(const Model& model, StepTolerances tolerances, LinearMethod method, TimeOrder order)
    : model_(model),
      tolerances_(tolerances),
      order_(order),
      balance_(std::make_unique<Balance>(model, tolerances)),
      directions_(make_directions(model, method, [this] { return stop_requested_ && stop_requested_(); })) {}

NewtonStepper::~NewtonStepper() = default;

void NewtonStepper::forget_factor() { directions_->forget_factor(); }

StepReport NewtonStepper::advance(const State& state, double duration_s, bool from_rest, State& next,
                                  const Model* grown) {
  const TimeOrder order = std::min(order_, possible_order(state, duration_s));
  BackwardDifference rates{duration_s, 0};
  Vectors earlier;
  if (order == TimeOrder::second) {
    rates = backward_difference(duration_s, state.trend.step_s);
    earlier = earlier_positions(state);
  }
  Attempt attempt{{.positions = state.positions,
                   .previous_positions = state.positions,
                   .previous_velocities = state.velocities,
                   .rate_s = rates.rate_s,
                   .end_time_s = state.time_s + duration_s,
                   .earlier_positions = earlier,
                   .ahead = rates.ahead,
                   .internals = state.internals,
                   .grown = grown}};
  start(state, duration_s, from_rest, attempt);
  if (iterate(attempt)) accept(state, attempt.step, duration_s, order, std::move(attempt.at), next);
  return attempt.report;
}

Iterate NewtonStepper::forecast(const State& state, double duration_s) const {
  Iterate at{state.positions, state.multipliers, state.obstacle_forces, state.on_obstacle};
  const State::Trend& trend = state.trend;
  // Mean velocities belong to the middles of steps.
  const double later_s = 0.5 * (trend.step_s + duration_s);
  const Vectors& velocities = mean_velocities(state);
  for (std::size_t n = 0; n < at.positions.size(); ++n) {
    at.positions[n] += duration_s * velocities[n];
    if (!trend.accelerations.empty()) at.positions[n] += duration_s * later_s * trend.accelerations[n];
  }
  for (std::size_t m = 0; m < trend.multiplier_rates.size(); ++m)
    at.multipliers[m] += duration_s * trend.multiplier_rates[m];
  if (inverted_cell(model_.tissue, at.positions)) at.positions = state.positions;
  return at;
}

void NewtonStepper::start(const State& state, double duration_s, bool from_rest, Attempt& a) const {
  const auto start_at = [&](Iterate at, Attempt& attempt) {
    attempt.at = std::move(at);
    attempt.obstacle_changes.assign(attempt.at.on_obstacle.size(), 0);
    balance_->revise_contacts(attempt.at, attempt.obstacle_changes);
    take_residual(attempt);
  };
  Iterate unmoved{state.positions, state.multipliers, state.obstacle_forces, state.on_obstacle};
  if (from_rest) return start_at(std::move(unmoved), a);
  start_at(forecast(state, duration_s), a);
  // Near the inversion barrier, the prediction drives corners deep into it, and Newton's method takes many iterations
  // back: fewer from the previous positions.
  constexpr double poor_forecast = 0.05;  // residual's forces, relative
  if (a.now.force < poor_forecast) return;
  Attempt other{a.step};
  start_at(std::move(unmoved), other);
  if (other.now.finite() && !(a.now.force <= other.now.force)) a = std::move(other);
  a.step.positions = a.at.positions;
}

void NewtonStepper::take_residual(Attempt& a) const {
  a.step.positions = a.at.positions;
  a.now = balance_->residual(a.step, a.at);
}

bool NewtonStepper::settle_contacts(Attempt& a) const {
  if (!balance_->revise_contacts(a.at, a.obstacle_changes)) return true;
  take_residual(a);
  return false;
}

bool NewtonStepper::give_up(Attempt& a, StepReport::Status status) const {
  a.report.status = status;
  if (status != StepReport::Status::interrupted) a.report.cell = cell_with_largest(model_.tissue, a.now.forces);
  return false;
}

// Newton's iterations. False, with the reason in the report, if they do not converge.
bool NewtonStepper::iterate(Attempt& a) {
  constexpr int most_slow_iterations = 12;
  for (;; ++a.report.newton_iterations) {
    a.report.residual = a.now.force;
    a.report.constraint_error = a.now.constraint;
    if (!a.now.finite()) return give_up(a, StepReport::Status::not_finite);
    if (balance_->is_solved(a.now) && (a.contacts_settled || settle_contacts(a))) break;
    if (stop_requested_ && stop_requested_()) return give_up(a, StepReport::Status::interrupted);
    if (a.report.newton_iterations >= tolerances_.max_iterations || a.slow_iterations >= most_slow_iterations)
      return give_up(a, StepReport::Status::no_convergence);
    if (!improve(a)) return false;
    a.contacts_settled = settle_contacts(a);
  }
  a.step.positions = a.at.positions;
  a.report.status = StepReport::Status::converged;
  return true;
}

// One direction, and the search along it. False, with the reason in the report, if there is none.
bool NewtonStepper::improve(Attempt& a) {
  a.step.positions = a.at.positions;
  const double relative_tolerance =
      0.3 * std::min(tolerances_.force / a.now.force, tolerances_.constraint / a.now.constraint);
  Direction direction;
  NewtonDirections::Cost cost;
  const auto status =
      directions_->find(a.step, a.at, a.now, {a.residual_reduction, relative_tolerance}, direction, cost);
  a.report.factorisations += cost.factorisations;
  a.report.linear_solves += cost.linear_solves;
  if (status == NewtonDirections::Status::interrupted) return give_up(a, StepReport::Status::interrupted);
  if (status == NewtonDirections::Status::singular) return give_up(a, StepReport::Status::singular_system);
  const double before = a.now.merit();
  const std::optional<double> part = search_line(direction, a);
  if (!part) return false;
  a.residual_reduction = a.now.merit() / before;
  // Slow iterations do not halve the residual; those with short searches that hardly reduce it count as several: beyond
  // a limit point there is no solution nearby, and half the step finds one sooner.
  constexpr int slow_ones_of_a_short_search = 4;
  constexpr double short_search = 0.1, hardly_reduced = 0.95;
  const bool is_short = *part < short_search && a.residual_reduction > hardly_reduced;
  a.slow_iterations = a.residual_reduction > 0.5 ? a.slow_iterations + (is_short ? slow_ones_of_a_short_search : 1) : 0;
  return true;
}

// Line search: shorten the direction until laws allow it, no element inverts and the residual falls; if it never falls,
// take the length of the smallest residual. Returns the part of the direction at which the search ended; empty, with
// the reason in the report, if every length inverts an element or gives a force that is not finite.
std::optional<double> NewtonStepper::search_line(const Direction& d, Attempt& a) const {
  std::optional<CellId> blocking;
  std::optional<std::pair<Iterate, Residual>> best;
  double part = 1;
  for_laws(model_, a.step, [&](const Law& law, const Step& law_step) {
    part = std::min(part, law.max_fraction(law_step, d.positions));
  });
  for (int halving = 0; halving < 8; ++halving, part *= 0.5) {
    Iterate trial = a.at;
    parallel_for(trial.positions.size(), [&](std::size_t n) { trial.positions[n] += part * d.positions[n]; });
    return_to_obstacles(model_, balance_->contacts(), trial);
    blocking = inverted_cell(model_.tissue, trial.positions);
    if (blocking) continue;
    for (std::size_t m = 0; m < trial.multipliers.size(); ++m) trial.multipliers[m] += part * d.multipliers[m];
    Step there = a.step;
    there.positions = trial.positions;
    Residual r = balance_->residual(there, trial);
    if (r.finite() && (!best || r.merit() < best->second.merit())) best.emplace(std::move(trial), std::move(r));
    if (best && best->second.merit() < (1 - 1e-4 * part) * a.now.merit()) break;
  }
  if (!best) {
    give_up(a, blocking ? StepReport::Status::inverted_element : StepReport::Status::not_finite);
    if (blocking) a.report.cell = blocking;
    return std::nullopt;
  }
  a.at = std::move(best->first);
  a.now = std::move(best->second);
  return part;
}

void NewtonStepper::accept(const State& state, const Step& step, double duration_s, TimeOrder order, Iterate at,
                           State& next) const {
  next.internals = next_internals(model_, step);
  next.time_s = state.time_s + duration_s;
  next.divided_until_s = state.divided_until_s;
  next.exchanges = state.exchanges;
  next.positions = std::move(at.positions);
  next.multipliers = std::move(at.multipliers);
  next.obstacle_forces = std::move(at.obstacle_forces);
  next.on_obstacle = std::move(at.on_obstacle);
  record_motion(state, duration_s, order, next);
}

}  // namespace plica
