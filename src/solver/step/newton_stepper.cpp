#include "solver/step/newton_stepper.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"

namespace plica {

NewtonStepper::NewtonStepper(const Model& model, StepTolerances tolerances, LinearMethod method, TimeOrder order)
    : model_(model),
      tolerances_(tolerances),
      order_(order),
      balance_(model, tolerances),
      directions_(make_directions(model, method, [this] { return stop_requested_ && stop_requested_(); })) {}

NewtonStepper::~NewtonStepper() = default;

void NewtonStepper::forget_factor() { directions_->forget_factor(); }

// Goes along the direction as far as laws allow, elements stay upright and the residual falls; if it falls nowhere,
// where it is least. False, with the reason in the report, when no length keeps every element upright and every force
// finite.
bool NewtonStepper::search_line(const Step& step, const Direction& d, Iterate& at, Residual& now,
                                StepReport& report) const {
  std::optional<CellId> blocking;
  std::optional<std::pair<Iterate, Residual>> best;
  double part = 1;
  for_laws(model_, step,
           [&](const Law& law, const Step& own) { part = std::min(part, law.max_fraction(own, d.positions)); });
  for (int halving = 0; halving < 8; ++halving, part *= 0.5) {
    Iterate trial = at;
    parallel_for(trial.positions.size(), [&](std::size_t n) { trial.positions[n] += part * d.positions[n]; });
    return_to_obstacles(model_, balance_.contacts(), trial);
    blocking = inverted_cell(model_.tissue, trial.positions);
    if (blocking) continue;
    for (std::size_t m = 0; m < trial.multipliers.size(); ++m) trial.multipliers[m] += part * d.multipliers[m];
    Step there = step;
    there.positions = trial.positions;
    Residual r = balance_.residual(there, trial);
    if (r.finite() && (!best || r.merit() < best->second.merit())) best.emplace(std::move(trial), std::move(r));
    if (best && best->second.merit() < (1 - 1e-4 * part) * now.merit()) break;
  }
  if (!best) {
    report.status = blocking ? StepReport::Status::inverted_element : StepReport::Status::not_finite;
    report.cell = blocking ? blocking : cell_with_largest(model_.tissue, now.forces);
    return false;
  }
  at = std::move(best->first);
  now = std::move(best->second);
  return true;
}

Iterate NewtonStepper::forecast(const State& state, double duration_s) const {
  Iterate at{state.positions, state.multipliers, state.contact_forces, state.in_contact};
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

StepReport NewtonStepper::advance(const State& state, double duration_s, bool from_rest, State& next,
                                  const Model* grown) {
  const auto unmoved = [&] {
    return Iterate{state.positions, state.multipliers, state.contact_forces, state.in_contact};
  };
  Iterate at = from_rest ? unmoved() : forecast(state, duration_s);
  const TimeOrder order = std::min(order_, possible_order(state, duration_s));
  BackwardDifference rates{duration_s, 0};
  Vectors earlier;
  if (order == TimeOrder::second) {
    rates = backward_difference(duration_s, state.trend.step_s);
    earlier = earlier_positions(state);
  }
  Step step{.positions = at.positions,
            .previous_positions = state.positions,
            .previous_velocities = state.velocities,
            .rate_s = rates.rate_s,
            .end_time_s = state.time_s + duration_s,
            .earlier_positions = earlier,
            .ahead = rates.ahead,
            .internals = state.internals,
            .grown = grown};
  StepReport report;
  std::vector<unsigned char> contact_changes(at.in_contact.size());
  const auto first_residual = [&](Iterate& start, std::vector<unsigned char>& changes) {
    balance_.revise_contacts(start, changes);
    step.positions = start.positions;
    return balance_.residual(step, start);
  };
  Residual now = first_residual(at, contact_changes);
  // Near the inversion barrier, the prediction drives corners deep into it, and Newton's method takes many iterations
  // back: fewer from the previous positions.
  constexpr double poor_forecast = 0.05;  // residual's forces, relative
  if (!from_rest && !(now.force < poor_forecast)) {
    Iterate start = unmoved();
    std::vector<unsigned char> changes(start.in_contact.size());
    if (Residual there = first_residual(start, changes); there.finite() && !(now.force <= there.force)) {
      at = std::move(start);
      contact_changes = std::move(changes);
      now = std::move(there);
    }
    step.positions = at.positions;
  }
  // Whether nothing wants to leave or join an obstacle, by the forces of this iterate.
  const auto settle_contacts = [&] {
    if (!balance_.revise_contacts(at, contact_changes)) return true;
    step.positions = at.positions;
    now = balance_.residual(step, at);
    return false;
  };
  bool contacts_settled = false;
  constexpr int most_slow_iterations = 12;  // in a row, none of which halves the residual
  double residual_reduction = 0;            // by the last direction
  int slow_iterations = 0;
  for (;; ++report.newton_iterations) {
    report.residual = now.force;
    report.constraint_error = now.constraint;
    if (!now.finite()) {
      report.status = StepReport::Status::not_finite;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    if (balance_.is_solved(now) && (contacts_settled || settle_contacts())) break;
    if (stop_requested_ && stop_requested_()) {
      report.status = StepReport::Status::interrupted;
      return report;
    }
    if (report.newton_iterations >= tolerances_.max_iterations || slow_iterations >= most_slow_iterations) {
      report.status = StepReport::Status::no_convergence;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    step.positions = at.positions;
    Direction direction;
    NewtonDirections::Cost cost;
    const double relative_tolerance =
        0.3 * std::min(tolerances_.force / now.force, tolerances_.constraint / now.constraint);
    const auto status = directions_->find(step, at, now, {residual_reduction, relative_tolerance}, direction, cost);
    report.factorisations += cost.factorisations;
    report.linear_solves += cost.linear_solves;
    if (status == NewtonDirections::Status::interrupted) {
      report.status = StepReport::Status::interrupted;
      return report;
    }
    if (status == NewtonDirections::Status::singular) {
      report.status = StepReport::Status::singular_system;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    const double before = now.merit();
    if (!search_line(step, direction, at, now, report)) return report;
    residual_reduction = now.merit() / before;
    slow_iterations = residual_reduction > 0.5 ? slow_iterations + 1 : 0;
    contacts_settled = settle_contacts();
  }
  step.positions = at.positions;
  accept(state, step, duration_s, order, std::move(at), next);
  report.status = StepReport::Status::converged;
  return report;
}

void NewtonStepper::accept(const State& state, const Step& step, double duration_s, TimeOrder order, Iterate at,
                           State& next) const {
  next.internals = next_internals(model_, step);
  next.time_s = state.time_s + duration_s;
  next.divided_until_s = state.divided_until_s;
  next.positions = std::move(at.positions);
  next.multipliers = std::move(at.multipliers);
  next.contact_forces = std::move(at.contact_forces);
  next.in_contact = std::move(at.in_contact);
  record_motion(state, duration_s, order, next);
}

}  // namespace plica
