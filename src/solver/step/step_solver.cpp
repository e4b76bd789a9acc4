#include "solver/step/step_solver.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "core/parallel.hpp"

namespace plica {

StepSolver::StepSolver(const Model& model, StepTolerances tolerances, LinearMethod method, TimeOrder order)
    : model_(model),
      tolerances_(tolerances),
      order_(order),
      force_scale_(model.force_scale()),
      force_rounding_(model.force_rounding()),
      volume_rounding_(model.volume_rounding()),
      directions_(make_directions(model, method, [this] { return stop_requested_ && stop_requested_(); })) {}

StepSolver::~StepSolver() = default;

void StepSolver::forget_factor() { directions_->forget_factor(); }

Residual StepSolver::residual(const Step& step, Iterate& at) const {
  Residual r;
  r.forces.assign(at.positions.size(), Vec3::Zero());
  Vectors of_law(at.positions.size(), Vec3::Zero());
  double balanced = 0;  // squared norm of the forces that have to balance
  const auto take = [&] {
    model_.tissue.carry_hanging(of_law);
    balanced += parallel_squared_norm(of_law);
    parallel_for(of_law.size(), [&](std::size_t n) {
      r.forces[n] += of_law[n];
      of_law[n].setZero();
    });
  };
  for (const auto& law : model_.laws) {
    law->add_forces(step, of_law);
    take();
  }
  if (model_.volumes_are_held) {
    model_.volumes.add_forces(at.positions, at.pressures, of_law);
    take();
    r.volume_deficit = model_.volumes.volumes(at.positions);
    for (std::size_t c = 0; c < r.volume_deficit.size(); ++c) {
      r.volume_deficit[c] = model_.volumes.targets()[c] - r.volume_deficit[c];
      r.volume = std::max(r.volume, std::abs(r.volume_deficit[c] / model_.volumes.targets()[c]));
    }
  }
  // The shell bears what else would push nodes outward along their normals.
  const auto in_contact = [&](const auto& body) {
    parallel_for(at.in_contact.size(), [&](std::size_t k) {
      if (!at.in_contact[k]) return;
      const std::size_t n = model_.vitelline->nodes()[k].index();
      const Vec3 inward = model_.vitelline->gap(at.positions[n]).inward;
      body(k, n, inward, Vec3(without_held(model_, n, inward).normalized()));
    });
  };
  in_contact([&](std::size_t k, std::size_t n, const Vec3& inward, const Vec3& normal) {
    at.contact_forces[k] = -normal.dot(r.forces[n]) / normal.dot(inward);
    of_law[n] = at.contact_forces[k] * inward;
  });
  take();

  Vectors& free = of_law;
  parallel_for(model_.tissue.free_node_count(), [&](std::size_t n) { free[n] = without_held(model_, n, r.forces[n]); });
  in_contact(
      [&](std::size_t, std::size_t n, const Vec3&, const Vec3& normal) { free[n] -= normal.dot(free[n]) * normal; });
  // Relative to the forces that balance; but where those are next to none, or as small as what rounding makes, to a
  // floor.
  const double floor = std::max(1e-4 * force_scale_, force_rounding_ / tolerances_.force);
  r.force = std::sqrt(parallel_squared_norm(free)) / (std::sqrt(balanced) + floor);
  return r;
}

bool StepSolver::revise_contacts(Iterate& at) const {
  std::atomic<bool> changed = false;
  parallel_for(at.in_contact.size(), [&](std::size_t k) {
    const std::size_t n = model_.vitelline->nodes()[k].index();
    const Vitelline::Gap gap = model_.vitelline->gap(at.positions[n]);
    // A node that is held where the shell would push it is the hold's business.
    if (without_held(model_, n, gap.inward).norm() < 1e-6) {
      at.in_contact[k] = 0;
      at.contact_forces[k] = 0;
    } else if (at.in_contact[k]) {
      // Pulled inward for real: let go. Forces of rounding's size are none.
      if (at.contact_forces[k] < -1e-12 * force_scale_) {
        at.in_contact[k] = 0;
        changed = true;
      }
      if (at.contact_forces[k] < 0) at.contact_forces[k] = 0;
    } else if (gap.value < -tolerances_.gap_um) {
      at.in_contact[k] = 1;
      changed = true;
    }
  });
  return_to_shell(model_, at);
  return changed;
}

// Goes along the direction as far as elements stay upright and the residual falls; if it falls nowhere, where it is
// least. False, with the reason in the report, when no length keeps every element upright and every force finite.
bool StepSolver::search_line(const Step& step, const Direction& d, Iterate& at, Residual& now,
                             StepReport& report) const {
  std::optional<CellId> blocking;
  std::optional<std::pair<Iterate, Residual>> best;
  double part = 1;
  for (int halving = 0; halving < 8; ++halving, part *= 0.5) {
    Iterate trial = at;
    parallel_for(trial.positions.size(), [&](std::size_t n) { trial.positions[n] += part * d.positions[n]; });
    return_to_shell(model_, trial);
    blocking = inverted_cell(model_.tissue, trial.positions);
    if (blocking) continue;
    for (std::size_t c = 0; c < trial.pressures.size(); ++c) trial.pressures[c] += part * d.pressures[c];
    Step there = step;
    there.positions = trial.positions;
    Residual r = residual(there, trial);
    if (r.finite() && (!best || r.merit() < best->second.merit())) best.emplace(std::move(trial), std::move(r));
    if (best && best->second.merit() < (1 - 1e-4 * part) * now.merit()) break;
  }
  if (!best) {
    report.outcome = blocking ? StepReport::Outcome::inverted_element : StepReport::Outcome::not_finite;
    report.cell = blocking ? blocking : cell_with_largest(model_.tissue, now.forces);
    return false;
  }
  at = std::move(best->first);
  now = std::move(best->second);
  return true;
}

Iterate StepSolver::forecast(const State& state, double duration_s) const {
  Iterate at{state.positions, state.pressures, state.contact_forces, state.in_contact};
  const State::Trend& trend = state.trend;
  // Mean velocities belong to the middles of steps.
  const double later_s = 0.5 * (trend.step_s + duration_s);
  const Vectors& velocities = mean_velocities(state);
  for (std::size_t n = 0; n < at.positions.size(); ++n) {
    at.positions[n] += duration_s * velocities[n];
    if (!trend.accelerations.empty()) at.positions[n] += duration_s * later_s * trend.accelerations[n];
  }
  for (std::size_t c = 0; c < trend.pressure_rates.size(); ++c) at.pressures[c] += duration_s * trend.pressure_rates[c];
  if (inverted_cell(model_.tissue, at.positions)) at.positions = state.positions;
  return at;
}

StepReport StepSolver::advance(const State& state, double duration_s, bool from_rest, State& next) {
  Iterate at = from_rest ? Iterate{state.positions, state.pressures, state.contact_forces, state.in_contact}
                         : forecast(state, duration_s);
  const TimeOrder order = std::min(order_, possible_order(state, duration_s));
  BackwardDifference rates{duration_s, 0};
  Vectors earlier;
  if (order == TimeOrder::second) {
    rates = backward_difference(duration_s, state.trend.step_s);
    earlier = state.positions;
    const Vectors& velocities = mean_velocities(state);
    parallel_for(earlier.size(), [&](std::size_t n) { earlier[n] -= state.trend.step_s * velocities[n]; });
  }
  Step step{.positions = at.positions,
            .previous_positions = state.positions,
            .previous_velocities = state.velocities,
            .rate_s = rates.rate_s,
            .end_time_s = state.time_s + duration_s,
            .earlier_positions = earlier,
            .ahead = rates.ahead};
  StepReport report;
  bool contacts_settled = !revise_contacts(at);
  Residual now = residual(step, at);
  constexpr int most_slow_iterations = 12;  // in a row, none of which halves the residual
  double left = 0;
  int slow_iterations = 0;
  for (;; ++report.newton_iterations) {
    report.residual = now.force;
    report.volume_error = now.volume;
    if (!now.finite()) {
      report.outcome = StepReport::Outcome::not_finite;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    const bool solved = now.force <= tolerances_.force && now.volume <= std::max(tolerances_.volume, volume_rounding_);
    if (contacts_settled && solved) break;
    if (stop_requested_ && stop_requested_()) {
      report.outcome = StepReport::Outcome::interrupted;
      return report;
    }
    if (report.newton_iterations >= tolerances_.max_iterations || slow_iterations >= most_slow_iterations) {
      report.outcome = StepReport::Outcome::no_convergence;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    step.positions = at.positions;
    Direction direction;
    NewtonDirections::Cost cost;
    const double accuracy = 0.3 * std::min(tolerances_.force / now.force, tolerances_.volume / now.volume);
    const auto outcome = directions_->find(step, at, now, {left, accuracy}, direction, cost);
    report.factorisations += cost.factorisations;
    report.linear_solves += cost.linear_solves;
    if (outcome == NewtonDirections::Outcome::interrupted) {
      report.outcome = StepReport::Outcome::interrupted;
      return report;
    }
    if (outcome == NewtonDirections::Outcome::singular) {
      report.outcome = StepReport::Outcome::singular_system;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    const double before = now.merit();
    if (!search_line(step, direction, at, now, report)) return report;
    left = now.merit() / before;
    slow_iterations = left > 0.5 ? slow_iterations + 1 : 0;
    contacts_settled = !revise_contacts(at);
    if (!contacts_settled) {
      step.positions = at.positions;
      now = residual(step, at);
    }
  }
  next.time_s = state.time_s + duration_s;
  next.divided_until_s = state.divided_until_s;
  next.positions = std::move(at.positions);
  next.pressures = std::move(at.pressures);
  next.contact_forces = std::move(at.contact_forces);
  next.in_contact = std::move(at.in_contact);
  record_motion(state, duration_s, order, next);
  report.outcome = StepReport::Outcome::converged;
  return report;
}

}  // namespace plica
