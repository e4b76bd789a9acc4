#include "solver/step/newton_stepper.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "solver/linear/node_frame.hpp"
#include "solver/step/obstacle_changes.hpp"

namespace plica {
namespace {

// Free normals of the contacts of a node, normalised, as columns.
Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals_of(const NodeObstacles& touched) {
  Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> normals(3, touched.count);
  for (int k = 0; k < touched.count; ++k) normals.col(k) = touched.free_normal[k].normalized();
  return normals;
}

}  // namespace

/// Residual of an iterate of a step, and the contacts of nodes with obstacles.
class Balance {
 public:
  Balance(const Model& model, const StepTolerances& tolerances)
      : model_(model),
        tolerances_(tolerances),
        contacts_(model),
        obstacle_changes_(model.tissue, contacts_),
        force_scale_(model.force_scale()),
        position_rounding_(model.position_rounding()),
        elastic_rounding_(model.elastic_rounding()) {
    for (std::size_t place = 0; place < model.constraint_count(); ++place)
      constraint_rounding_.push_back(model.constraint(place).rounding(model.tissue, position_rounding_));
  }

  /// Compute the residual and sets the obstacle forces of the iterate: obstacles bear the forces that push nodes
  /// outward along their normals.
  [[nodiscard]] Residual residual(const Step& step, Iterate& at) const {
    Residual r;
    r.forces.assign(at.positions.size(), Vec3::Zero());
    Vectors of_one(at.positions.size(), Vec3::Zero());
    double balanced = 0;  // squared norm of the forces that have to balance
    double rounding = elastic_rounding_;
    const auto take = [&] {
      model_.tissue.carry_hanging(of_one);
      balanced += parallel_squared_norm(of_one);
      parallel_for(of_one.size(), [&](std::size_t n) {
        r.forces[n] += of_one[n];
        of_one[n].setZero();
      });
    };
    for_laws(model_, step, [&](const Law& law, const Step& law_step) {
      law.add_forces(law_step, of_one);
      take();
      rounding += law.rounding(law_step, position_rounding_);
    });
    r.deficits.assign(at.multipliers.size(), 0.0);
    const Model& model = at_end(model_, step);
    for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t place) {
      constraint.add_forces(at.positions, std::span(at.multipliers).subspan(first, constraint.count()), of_one);
      take();
      const std::span<double> deficits = std::span(r.deficits).subspan(first, constraint.count());
      constraint.values(at.positions, deficits);
      double worst = 0;
      for (std::size_t f = 0; f < deficits.size(); ++f) {
        deficits[f] = constraint.targets()[f] - deficits[f];
        worst = std::max(worst, std::abs(deficits[f] / constraint.targets()[f]));
      }
      r.constraint = std::max(r.constraint, worst);
      r.constraint_excess =
          std::max(r.constraint_excess, worst / std::max(tolerances_.constraint, constraint_rounding_[place]));
    });
    add_obstacle_forces(at, r.forces, of_one);
    take();

    Vectors& free = of_one;
    parallel_for(model_.tissue.free_node_count(),
                 [&](std::size_t n) { free[n] = without_held(model_, n, r.forces[n]); });
    take_out_normals(at, free);
    // Relative to the balancing forces, but at least to a floor, where these are negligible or at rounding level.
    const double floor = std::max(1e-4 * force_scale_, rounding / tolerances_.force);
    r.force = std::sqrt(parallel_squared_norm(free)) / (std::sqrt(balanced) + floor);
    return r;
  }

  [[nodiscard]] bool is_solved(const Residual& residual) const {
    return residual.force <= tolerances_.force && residual.constraint_excess <= 1;
  }

  /// Release nodes pulled inward, adds nodes outside, and projects all onto their obstacles. Returns whether any
  /// contact changed. `changes`: contacts; number of changes in this step, updated here.
  bool revise_contacts(Iterate& at, std::span<unsigned char> changes) const {
    std::vector<char> wanted(at.on_obstacle.begin(), at.on_obstacle.end());
    parallel_for(wanted.size(), [&](std::size_t k) {
      const Obstacle::Gap gap = contacts_.gap(k, at.positions);
      // A node that is held where an obstacle would push it needs no contact.
      if (without_held(model_, contacts_.node(k).index(), gap.inward).norm() < 1e-6) {
        at.on_obstacle[k] = wanted[k] = 0;
        at.obstacle_forces[k] = 0;
      } else if (at.on_obstacle[k]) {
        // Release nodes that are pulled inward by more than rounding.
        if (at.obstacle_forces[k] < -1e-12 * force_scale_) wanted[k] = 0;
        if (at.obstacle_forces[k] < 0) at.obstacle_forces[k] = 0;
      } else if (gap.value < -tolerances_.gap_um) {
        wanted[k] = 1;
      }
    });
    const bool changed = obstacle_changes_.make(wanted, changes, at.on_obstacle);
    return_to_obstacles(model_, contacts_, at);
    return changed;
  }

  [[nodiscard]] const ObstacleContacts& contacts() const { return contacts_; }

 private:
  void add_obstacle_forces(Iterate& at, std::span<const Vec3> others, std::span<Vec3> forces) const {
    parallel_for(contacts_.node_count(), [&](std::size_t place) {
      const auto of_node = contacts_.at_node(place);
      const NodeObstacles touched = node_obstacles(model_, contacts_, of_node, at);
      if (touched.count == 0) return;
      const std::size_t n = contacts_.node(of_node.front()).index();
      if (touched.count == 1) {
        const Vec3 normal = touched.free_normal[0].normalized();
        double& force = at.obstacle_forces[touched.contact[0]];
        force = -normal.dot(others[n]) / normal.dot(touched.inward[0]);
        forces[n] = force * touched.inward[0];
        return;
      }
      const auto normals = normals_of(touched);
      Eigen::MatrixXd pushes(3, touched.count);
      for (int k = 0; k < touched.count; ++k) pushes.col(k) = touched.inward[k];
      const Eigen::VectorXd sizes =
          (normals.transpose() * pushes).partialPivLu().solve(-normals.transpose() * others[n]);
      for (const std::size_t k : of_node) at.obstacle_forces[k] = 0;  // redundant contacts bear none
      for (int k = 0; k < touched.count; ++k) at.obstacle_forces[touched.contact[k]] = sizes[k];
      forces[n] = pushes * sizes;
    });
  }
  void take_out_normals(const Iterate& at, std::span<Vec3> forces) const {
    parallel_for(contacts_.node_count(), [&](std::size_t place) {
      const auto of_node = contacts_.at_node(place);
      const NodeObstacles touched = node_obstacles(model_, contacts_, of_node, at);
      Vec3& force = forces[contacts_.node(of_node.front()).index()];
      if (touched.count == 1) {
        const Vec3 normal = touched.free_normal[0].normalized();
        force -= normal.dot(force) * normal;
      } else if (touched.count > 1) {
        const auto normals = normals_of(touched);
        force -= normals * (normals.transpose() * normals).ldlt().solve(normals.transpose() * force).eval();
      }
    });
  }

  const Model& model_;
  StepTolerances tolerances_;
  ObstacleContacts contacts_;
  ObstacleChanges obstacle_changes_;
  double force_scale_;                       // nN
  double position_rounding_;                 // um
  double elastic_rounding_;                  // nN: resulting error of elastic forces
  std::vector<double> constraint_rounding_;  // resulting error of relative values; constraints
};

NewtonStepper::NewtonStepper(const Model& model, StepTolerances tolerances, LinearMethod method, TimeOrder order)
    : model_(model),
      tolerances_(tolerances),
      order_(order),
      balance_(std::make_unique<Balance>(model, tolerances)),
      directions_(make_directions(model, method, [this] { return stop_requested_ && stop_requested_(); })) {}

NewtonStepper::~NewtonStepper() = default;

void NewtonStepper::forget_factor() { directions_->forget_factor(); }

// Line search: shorten the direction until laws allow it, no element inverts and the residual falls; if it never falls,
// take the length of the smallest residual. Returns the part of the direction at which the search ended; empty, with
// the reason in the report, if every length inverts an element or gives a force that is not finite.
std::optional<double> NewtonStepper::search_line(const Step& step, const Direction& d, Iterate& at, Residual& now,
                                                 StepReport& report) const {
  std::optional<CellId> blocking;
  std::optional<std::pair<Iterate, Residual>> best;
  double part = 1;
  for_laws(model_, step, [&](const Law& law, const Step& law_step) {
    part = std::min(part, law.max_fraction(law_step, d.positions));
  });
  for (int halving = 0; halving < 8; ++halving, part *= 0.5) {
    Iterate trial = at;
    parallel_for(trial.positions.size(), [&](std::size_t n) { trial.positions[n] += part * d.positions[n]; });
    return_to_obstacles(model_, balance_->contacts(), trial);
    blocking = inverted_cell(model_.tissue, trial.positions);
    if (blocking) continue;
    for (std::size_t m = 0; m < trial.multipliers.size(); ++m) trial.multipliers[m] += part * d.multipliers[m];
    Step there = step;
    there.positions = trial.positions;
    Residual r = balance_->residual(there, trial);
    if (r.finite() && (!best || r.merit() < best->second.merit())) best.emplace(std::move(trial), std::move(r));
    if (best && best->second.merit() < (1 - 1e-4 * part) * now.merit()) break;
  }
  if (!best) {
    report.status = blocking ? StepReport::Status::inverted_element : StepReport::Status::not_finite;
    report.cell = blocking ? blocking : cell_with_largest(model_.tissue, now.forces);
    return std::nullopt;
  }
  at = std::move(best->first);
  now = std::move(best->second);
  return part;
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

StepReport NewtonStepper::advance(const State& state, double duration_s, bool from_rest, State& next,
                                  const Model* grown) {
  const auto unmoved = [&] {
    return Iterate{state.positions, state.multipliers, state.obstacle_forces, state.on_obstacle};
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
  std::vector<unsigned char> obstacle_changes(at.on_obstacle.size());
  const auto first_residual = [&](Iterate& start, std::vector<unsigned char>& changes) {
    balance_->revise_contacts(start, changes);
    step.positions = start.positions;
    return balance_->residual(step, start);
  };
  Residual now = first_residual(at, obstacle_changes);
  // Near the inversion barrier, the prediction drives corners deep into it, and Newton's method takes many iterations
  // back: fewer from the previous positions.
  constexpr double poor_forecast = 0.05;  // residual's forces, relative
  if (!from_rest && !(now.force < poor_forecast)) {
    Iterate start = unmoved();
    std::vector<unsigned char> changes(start.on_obstacle.size());
    if (Residual there = first_residual(start, changes); there.finite() && !(now.force <= there.force)) {
      at = std::move(start);
      obstacle_changes = std::move(changes);
      now = std::move(there);
    }
    step.positions = at.positions;
  }
  // Whether the forces of this iterate change no contact.
  const auto settle_contacts = [&] {
    if (!balance_->revise_contacts(at, obstacle_changes)) return true;
    step.positions = at.positions;
    now = balance_->residual(step, at);
    return false;
  };
  bool contacts_settled = false;
  // Slow iterations do not halve the residual; so many in a row end the attempt. Short searches that hardly reduce it
  // count more: beyond a limit point there is no solution nearby, and half the step finds one sooner.
  constexpr int most_slow_iterations = 12, slow_ones_of_a_short_search = 6;
  constexpr double short_search = 0.1, hardly_reduced = 0.9;
  double residual_reduction = 0;  // by the last direction
  int slow_iterations = 0;
  for (;; ++report.newton_iterations) {
    report.residual = now.force;
    report.constraint_error = now.constraint;
    if (!now.finite()) {
      report.status = StepReport::Status::not_finite;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    if (balance_->is_solved(now) && (contacts_settled || settle_contacts())) break;
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
    const std::optional<double> part = search_line(step, direction, at, now, report);
    if (!part) return report;
    residual_reduction = now.merit() / before;
    const bool is_short = *part < short_search && residual_reduction > hardly_reduced;
    slow_iterations = residual_reduction > 0.5 ? slow_iterations + (is_short ? slow_ones_of_a_short_search : 1) : 0;
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
  next.obstacle_forces = std::move(at.obstacle_forces);
  next.on_obstacle = std::move(at.on_obstacle);
  record_motion(state, duration_s, order, next);
}

}  // namespace plica
