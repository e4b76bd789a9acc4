#include "solver/step_solver.hpp"

#include <algorithm>
#include <cmath>

namespace plica {

struct StepSolver::Iterate {
  Vectors positions;
  std::vector<double> pressures;       // cells
  std::vector<double> contact_forces;  // the vitelline's nodes
  std::vector<char> in_contact;
};

struct StepSolver::Residual {
  Vectors forces;                      // unbalanced, all directions; nodes
  std::vector<double> volume_deficit;  // target - V; cells
  double force = 0;                    // norm over free directions, relative
  double volume = 0;                   // largest relative error
  double gap_um = 0;                   // largest distance of a node in contact from the shell

  [[nodiscard]] bool finite() const { return std::isfinite(force) && std::isfinite(volume) && std::isfinite(gap_um); }
  /// One number to descend on; each part in units of what matters.
  [[nodiscard]] double merit() const { return force + 10 * volume + gap_um; }
};

struct StepSolver::Direction {
  Vectors positions;
  std::vector<double> pressures;
  std::vector<double> contact_forces;
};

StepSolver::StepSolver(const Model& model, StepTolerances tolerances)
    : model_(model),
      tolerances_(tolerances),
      force_scale_(model.force_scale()),
      force_rounding_(model.force_rounding()),
      volume_rounding_(model.volume_rounding()),
      free_nodes_(model.tissue.free_node_count()),
      matrix_(model),
      linear_solver_(make_direct_solver()) {
  linear_solver_->analyse(matrix_.pattern());
}

StepSolver::~StepSolver() = default;

void StepSolver::forget_factor() { factor_frames_.clear(); }

Vec3 StepSolver::free_part(std::size_t node, Vec3 direction) const {
  for (int axis = 0; axis < 3; ++axis)
    if (model_.held[node][axis]) direction[axis] = 0;
  return direction;
}

std::vector<NodeFrame> StepSolver::frames(const Iterate& at) const {
  std::vector<NodeFrame> frames(free_nodes_);
  // The fixed directions of each node, made orthonormal: held axes first, then the shell's normal.
  const auto add_fixed = [](NodeFrame& frame, const Vec3& direction) {
    frame.axes.col(frame.fixed++) = direction.normalized();
  };
  for (std::size_t n = 0; n < frames.size(); ++n)
    for (int axis = 0; axis < 3; ++axis)
      if (model_.held[n][axis]) add_fixed(frames[n], Vec3::Unit(axis));
  for (std::size_t k = 0; k < at.in_contact.size(); ++k)
    if (at.in_contact[k]) {
      const std::size_t n = model_.vitelline->nodes()[k].index();
      add_fixed(frames[n], free_part(n, model_.vitelline->gap(at.positions[n]).inward));
    }
  for (NodeFrame& frame : frames) {
    if (frame.fixed == 1) frame.axes.col(1) = frame.axes.col(0).unitOrthogonal();
    if (frame.fixed == 1 || frame.fixed == 2) frame.axes.col(2) = frame.axes.col(0).cross(frame.axes.col(1));
  }
  return frames;
}

StepSolver::Residual StepSolver::residual(const Step& step, const Iterate& at) const {
  Residual r;
  r.forces.assign(at.positions.size(), Vec3::Zero());
  Vectors of_law(at.positions.size(), Vec3::Zero());
  double balanced = 0;  // squared norm of the forces that have to balance
  const auto take = [&] {
    model_.tissue.carry_hanging(of_law);
    for (std::size_t n = 0; n < of_law.size(); ++n) {
      balanced += of_law[n].squaredNorm();
      r.forces[n] += of_law[n];
    }
    std::fill(of_law.begin(), of_law.end(), Vec3::Zero());
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
  for (std::size_t k = 0; k < at.in_contact.size(); ++k) {
    if (!at.in_contact[k]) continue;
    const std::size_t n = model_.vitelline->nodes()[k].index();
    const Vitelline::Gap gap = model_.vitelline->gap(at.positions[n]);
    of_law[n] = at.contact_forces[k] * gap.inward;
    r.gap_um = std::max(r.gap_um, std::abs(gap.value));
  }
  take();

  const std::vector<NodeFrame> node_frames = frames(at);
  double free = 0;
  for (std::size_t n = 0; n < free_nodes_; ++n) {
    const Vec3 local = node_frames[n].axes.transpose() * r.forces[n];
    for (int i = node_frames[n].fixed; i < 3; ++i) free += local[i] * local[i];
  }
  // Relative to the forces that balance; but where those are next to none, or as small as what rounding makes, to a
  // floor.
  const double floor = std::max(1e-4 * force_scale_, force_rounding_ / tolerances_.force);
  r.force = std::sqrt(free) / (std::sqrt(balanced) + floor);
  return r;
}

bool StepSolver::refresh_factor(const Step& step, const Iterate& at) {
  factor_frames_ = frames(at);
  factor_contacts_ = at.in_contact;
  factor_duration_s_ = step.duration_s;
  matrix_.set_zero();
  for (const auto& law : model_.laws) law->add_tangent(step, matrix_);
  if (model_.volumes_are_held) {
    model_.volumes.add_tangent(at.positions, at.pressures, matrix_);
    matrix_.set_volume_gradients(model_.volumes, at.positions);
  }
  for (std::size_t k = 0; k < at.in_contact.size(); ++k)
    if (at.in_contact[k]) {
      const NodeId node = model_.vitelline->nodes()[k];
      matrix_.add_block(node, node, -at.contact_forces[k] * model_.vitelline->gap(at.positions[node.index()]).hessian);
    }
  matrix_.write_values(factor_frames_, values_);
  if (linear_solver_->factorise(values_)) return true;
  forget_factor();
  return false;
}

StepSolver::Direction StepSolver::direction(const Iterate& at, const Residual& r) {
  const std::size_t nodes = free_nodes_;
  // What the shell prescribes: every node in contact goes back to it along its normal.
  Vectors prescribed(nodes, Vec3::Zero());
  for (std::size_t k = 0; k < at.in_contact.size(); ++k) {
    if (!at.in_contact[k]) continue;
    const std::size_t n = model_.vitelline->nodes()[k].index();
    const NodeFrame& frame = factor_frames_[n];
    const Vitelline::Gap gap = model_.vitelline->gap(at.positions[n]);
    const Vec3 normal = frame.axes.col(frame.fixed - 1);
    prescribed[n] = -gap.value / normal.dot(gap.inward) * normal;
  }
  Vectors right(nodes);
  matrix_.multiply(prescribed, right);
  for (std::size_t n = 0; n < nodes; ++n) right[n] = r.forces[n] - right[n];

  std::vector<double> unknowns(matrix_.pattern().size, 0.0);
  for (std::size_t n = 0; n < nodes; ++n) {
    const Vec3 local = factor_frames_[n].axes.transpose() * right[n];
    for (int i = factor_frames_[n].fixed; i < 3; ++i) unknowns[3 * n + i] = local[i];
  }
  const std::vector<double> rates = matrix_.volume_rates(prescribed);
  for (std::size_t c = 0; c < rates.size(); ++c) unknowns[3 * nodes + c] = rates[c] - r.volume_deficit[c];
  linear_solver_->solve(unknowns);

  Direction d{prescribed, std::vector<double>(unknowns.begin() + 3 * nodes, unknowns.end()),
              std::vector<double>(at.contact_forces.size(), 0.0)};
  d.pressures.resize(at.pressures.size(), 0.0);
  for (std::size_t n = 0; n < nodes; ++n)
    d.positions[n] += factor_frames_[n].axes * Vec3(unknowns[3 * n], unknowns[3 * n + 1], unknowns[3 * n + 2]);
  d.positions.resize(at.positions.size());
  model_.tissue.place_hanging(d.positions);

  // The shell's forces take up what is left along the normals: N dmu = A dx - J^T dlambda - forces.
  if (model_.vitelline) {
    Vectors left(nodes);
    matrix_.multiply(d.positions, left);
    std::vector<double> relieved = d.pressures;
    for (double& pressure : relieved) pressure = -pressure;
    matrix_.add_pressure_forces(relieved, left);
    for (std::size_t k = 0; k < at.in_contact.size(); ++k) {
      if (!at.in_contact[k]) continue;
      const std::size_t n = model_.vitelline->nodes()[k].index();
      const Vec3 normal = factor_frames_[n].axes.col(factor_frames_[n].fixed - 1);
      d.contact_forces[k] =
          normal.dot(left[n] - r.forces[n]) / normal.dot(model_.vitelline->gap(at.positions[n]).inward);
    }
  }
  return d;
}

bool StepSolver::revise_contacts(Iterate& at) const {
  bool changed = false;
  for (std::size_t k = 0; k < at.in_contact.size(); ++k) {
    const std::size_t n = model_.vitelline->nodes()[k].index();
    const Vitelline::Gap gap = model_.vitelline->gap(at.positions[n]);
    // A node that is held where the shell would push it is the hold's business.
    if (free_part(n, gap.inward).norm() < 1e-6) {
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
  }
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
    for (std::size_t n = 0; n < trial.positions.size(); ++n) trial.positions[n] += part * d.positions[n];
    model_.tissue.place_hanging(trial.positions);
    blocking = inverted_cell(model_.tissue, trial.positions);
    if (blocking) continue;
    for (std::size_t c = 0; c < trial.pressures.size(); ++c) trial.pressures[c] += part * d.pressures[c];
    for (std::size_t k = 0; k < trial.contact_forces.size(); ++k) trial.contact_forces[k] += part * d.contact_forces[k];
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

StepReport StepSolver::advance(const State& state, double duration_s, bool from_rest, State& next) {
  Iterate at{state.positions, state.pressures, state.contact_forces, state.in_contact};
  if (!from_rest) {
    for (std::size_t n = 0; n < at.positions.size(); ++n) at.positions[n] += duration_s * state.velocities[n];
    if (inverted_cell(model_.tissue, at.positions)) at.positions = state.positions;
  }
  Step step{at.positions, state.positions, state.velocities, duration_s, state.time_s + duration_s};
  StepReport report;
  bool contacts_settled = !revise_contacts(at);
  Residual now = residual(step, at);
  constexpr int most_slow_iterations = 12;  // in a row, none of which halves the residual
  bool slow = false;
  int slow_iterations = 0;
  for (;; ++report.newton_iterations) {
    report.residual = now.force;
    report.volume_error = now.volume;
    if (!now.finite()) {
      report.outcome = StepReport::Outcome::not_finite;
      report.cell = cell_with_largest(model_.tissue, now.forces);
      return report;
    }
    const bool solved = now.force <= tolerances_.force && now.gap_um <= tolerances_.gap_um &&
                        now.volume <= std::max(tolerances_.volume, volume_rounding_);
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
    // A factor of a step of nearly this length converges nearly as fast; of other contacts it has the wrong unknowns.
    constexpr double alike = 0.2;
    const bool stale = factor_frames_.empty() || std::abs(factor_duration_s_ / duration_s - 1) > alike ||
                       factor_contacts_ != at.in_contact;
    if (stale || slow) {
      step.positions = at.positions;
      ++report.factorisations;
      if (!refresh_factor(step, at)) {
        report.outcome = StepReport::Outcome::singular_system;
        report.cell = cell_with_largest(model_.tissue, now.forces);
        return report;
      }
    }
    const double before = now.merit();
    ++report.linear_solves;
    if (!search_line(step, direction(at, now), at, now, report)) return report;
    slow = now.merit() > 0.1 * before;
    slow_iterations = now.merit() > 0.5 * before ? slow_iterations + 1 : 0;
    contacts_settled = !revise_contacts(at);
    if (!contacts_settled) {
      step.positions = at.positions;
      now = residual(step, at);
    }
  }
  next.velocities.resize(at.positions.size());
  for (std::size_t n = 0; n < at.positions.size(); ++n)
    next.velocities[n] = (at.positions[n] - state.positions[n]) / duration_s;
  next.time_s = state.time_s + duration_s;
  next.divided_until_s = state.divided_until_s;
  next.positions = std::move(at.positions);
  next.pressures = std::move(at.pressures);
  next.contact_forces = std::move(at.contact_forces);
  next.in_contact = std::move(at.in_contact);
  report.outcome = StepReport::Outcome::converged;
  return report;
}

}  // namespace plica
