#include "solver/linear/krylov_directions.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "solver/algebra/block_cholesky.hpp"

namespace plica {
namespace {

constexpr std::size_t most_contact_changes = 32;  // before the factor is made anew
constexpr double far_from_balance = 0.1;          // residual's forces, relative

// gamma times the size of a cell, over the mean stiffness of a node. Large, so that few iterations are left for the
// pressures; but single precision has to carry A beside it, multigrid finds nearly incompressible cells hard (and has
// PressureFactor for the pressures: twice or half of gamma changes little), and within cells of several elements it
// resists what the exact volumes allow. With a factor, a third takes a fifth more iterations, three times as much no
// fewer.
double regularisation(KrylovDirections::Inverse inverse, const Cell& cell) {
  if (cell.element_count > 1) return 3;
  return inverse == KrylovDirections::Inverse::multigrid ? 5 : 150;
}

/// To which Newton's method can use a direction: its own error leaves a part of the residual that falls with the
/// residual itself; more where it has been seen to converge slowly (Eisenstat and Walker 1996, choice 2).
double useful_tolerance(const Residual& residual, const NewtonDirections::Wish& wish) {
  const double useful = std::clamp(std::max(0.05 * residual.force, 0.5 * wish.left * wish.left), 1e-4, 1e-2);
  return std::clamp(wish.accuracy, useful, 0.1);
}

/// The share that reducing the residual to this has of a solve to 1e-4.
double share_of_solve(double residual) { return std::clamp(std::log10(residual) / -4, 0.1, 4.0); }

}  // namespace

KrylovDirections::KrylovDirections(const Model& model, Inverse inverse, std::function<bool()> stop_requested)
    : model_(model),
      stop_requested_(std::move(stop_requested)),
      inverse_(inverse),
      nodes_(model.tissue.node_count()),
      matrix_(model),
      price_of_factor_(inverse == Inverse::multigrid ? 5 : 30),
      jacobian_(matrix_.jacobian()) {
  if (inverse == Inverse::multigrid) {
    preconditioner_ = make_multigrid(matrix_.layout());
  } else {
    auto factor = std::make_unique<BlockCholesky>(matrix_.layout());
    factor_ = factor.get();
    preconditioner_ = std::move(factor);
  }
  // Cells of several elements have nodes inside that feel the difference of any two pressures.
  const bool is_refined = model.tissue.elements.size() >= 2 * model.tissue.cells.size();
  if (inverse == Inverse::multigrid && jacobian_.cells() > 0 && !is_refined)
    pressures_.emplace(jacobian_, model.tissue.free_node_count());
}

void KrylovDirections::weigh_pressures() {
  const double stiffness = matrix_.mean_diagonal();
  pressure_weights_.clear();
  for (std::size_t c = 0; c < jacobian_.cells(); ++c) {
    const double target = model_.volumes.targets()[c], size = std::cbrt(target);
    pressure_weights_.push_back(regularisation(inverse_, model_.tissue.cells[c]) * stiffness / (size * target));
  }
}

std::span<Vec3> KrylovDirections::of_nodes(Vector& vector) const {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  return {reinterpret_cast<Vec3*>(vector.data()), nodes_};
}
std::span<const Vec3> KrylovDirections::of_nodes(const Vector& vector) const {
  return {reinterpret_cast<const Vec3*>(vector.data()), nodes_};
}
std::span<double> KrylovDirections::of_cells(Vector& vector) const { return std::span(vector).subspan(3 * nodes_); }
std::span<const double> KrylovDirections::of_cells(const Vector& vector) const {
  return std::span(vector).subspan(3 * nodes_);
}

void KrylovDirections::project(std::span<Vec3> vectors) const {
  parallel_for(fixed_nodes_.size(), [&](std::size_t k) {
    const std::size_t n = fixed_nodes_[k];
    vectors[n] = frames_[n].free_part(vectors[n]);
  });
}

void KrylovDirections::linearise(const Iterate& at) {
  frames_ = node_frames(model_, at);
  fixed_nodes_.clear();
  for (std::size_t n = 0; n < frames_.size(); ++n)
    if (frames_[n].fixed > 0) fixed_nodes_.push_back(n);
  contact_tangents_.clear();
  for (std::size_t k = 0; k < at.in_contact.size(); ++k)
    if (at.in_contact[k]) {
      const std::size_t n = model_.vitelline->nodes()[k].index();
      contact_tangents_.emplace_back(n, -at.contact_forces[k] * model_.vitelline->gap(at.positions[n]).hessian);
    }
  if (model_.volumes_are_held) jacobian_.update(model_.volumes, at.positions);
}

bool KrylovDirections::refresh(const Step& step, const Iterate& at) {
  has_factor_ = false;
  // The semidefinite part of the tangent serves where all of it is not definite.
  for (const bool semidefinite : {false, true}) {
    Step here = step;
    here.semidefinite_tangent = semidefinite;
    matrix_.assemble(model_, here, at);
    weigh_pressures();
    if (pressures_ && !pressures_->factorise(jacobian_, matrix_, frames_)) continue;
    matrix_.add_volume_stiffness(model_, at.positions, pressure_weights_);
    matrix_.write_projected_blocks(frames_, values_);
    has_factor_ = preconditioner_->factorise(values_, rigid_motions(at));
    if (!has_factor_) continue;
    if (factor_ != nullptr) border_.begin(model_, matrix_, frames_, at.in_contact, most_contact_changes);
    made_from_ = factor_memory(step, at);
    return true;
  }
  return false;
}

FactorMemory KrylovDirections::memory() const {
  if (!has_factor_) return {};
  FactorMemory memory = made_from_;
  if (factor_ != nullptr) border_.remember(memory);
  memory.iterations_when_new = iterations_when_new_;
  memory.wasted_iterations = wasted_iterations_;
  return memory;
}

void KrylovDirections::recall(const FactorMemory& memory) {
  if (memory.empty()) return;
  linearise(memory.at);
  if (!refresh(step_of(memory), memory.at)) return;
  if (factor_ != nullptr) border_.recall(memory, *factor_);
  iterations_when_new_ = memory.iterations_when_new;
  wasted_iterations_ = memory.wasted_iterations;
}

UninitialisedVector<float> KrylovDirections::rigid_motions(const Iterate& at) const {
  Vec3 middle = Vec3::Zero();
  for (std::size_t n = 0; n < frames_.size(); ++n) middle += at.positions[n] / static_cast<double>(frames_.size());
  double size = 0;
  for (std::size_t n = 0; n < frames_.size(); ++n) size = std::max(size, (at.positions[n] - middle).norm());
  UninitialisedVector<float> motions(18 * frames_.size());
  parallel_for(frames_.size(), [&](std::size_t n) {
    Eigen::Matrix<double, 3, 6> of_node;
    of_node << Mat3::Identity(), -cross_matrix((at.positions[n] - middle) / size);
    for (int j = 0; j < 6; ++j) of_node.col(j) = frames_[n].free_part(of_node.col(j));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) motions[18 * n + 6 * i + j] = static_cast<float>(of_node(i, j));
  });
  return motions;
}

void KrylovDirections::multiply(const Step& step, const Iterate& at, const Vector& direction, Vector& product) const {
  const std::span<const Vec3> dx = of_nodes(direction);
  const std::span<Vec3> forces = of_nodes(product);
  parallel_for(forces.size(), [&](std::size_t n) { forces[n].setZero(); });
  for (const auto& law : model_.laws) law->add_tangent_product(step, dx, forces);
  if (model_.volumes_are_held && !step.semidefinite_tangent)
    model_.volumes.add_tangent_product(at.positions, at.pressures, dx, forces);
  model_.tissue.carry_hanging(forces);
  for (const auto& [node, tangent] : contact_tangents_) forces[node] += tangent * dx[node];
  jacobian_.add_forces(of_cells(direction), -1, forces);
  project(forces);
  jacobian_.rates(dx, of_cells(product));
  parallel_for(of_cells(product).size(), [&](std::size_t c) { of_cells(product)[c] *= -volume_unit_; });
}

void KrylovDirections::apply_inverse(std::span<Vec3> x) const {
  if (factor_ != nullptr) return border_.solve(*factor_, x);
  single_.resize(3 * x.size());
  parallel_for(x.size(), [&](std::size_t n) {
    for (int i = 0; i < 3; ++i) single_[3 * n + i] = static_cast<float>(x[n][i]);
  });
  preconditioner_->solve(single_);
  parallel_for(x.size(), [&](std::size_t n) {
    for (int i = 0; i < 3; ++i) x[n][i] = single_[3 * n + i];
  });
}

void KrylovDirections::precondition(const Vector& residual, Vector& result) const {
  // dlambda = -gamma W (g + J dx),  (A + gamma J^T W J) dx = f - gamma J^T W g.
  const std::span<double> pressures = of_cells(result);
  const std::span<const double> volumes = of_cells(residual);
  parallel_for(pressures.size(),
               [&](std::size_t c) { pressures[c] = -pressure_weights_[c] / volume_unit_ * volumes[c]; });
  // J as in the factor: with another, gamma would carry the difference into directions that hardly resist.
  const VolumeJacobian& J = matrix_.jacobian();
  const std::span<Vec3> dx = of_nodes(result);
  const std::span<const Vec3> forces = of_nodes(residual);
  parallel_for(dx.size(), [&](std::size_t n) { dx[n] = forces[n]; });
  J.add_forces(pressures, 1, dx);
  project(dx);
  apply_inverse(dx.first(frames_.size()));
  project(dx);
  model_.tissue.place_hanging(dx);
  J.add_rates(dx, pressure_weights_, -1, pressures);
  if (!pressures_) return;
  // What gamma W leaves of the volumes' rates: p = L^-1 (g + J dx), dlambda -= p, dx -= D^-1 J^T p.
  chequered_.resize(pressures.size());
  J.rates(dx, chequered_);
  parallel_for(pressures.size(), [&](std::size_t c) { chequered_[c] += volumes[c] / volume_unit_; });
  pressures_->solve(chequered_);
  parallel_for(pressures.size(), [&](std::size_t c) { pressures[c] -= chequered_[c]; });
  moved_.resize(frames_.size());
  parallel_for(moved_.size(), [&](std::size_t n) { moved_[n].setZero(); });
  J.add_forces(chequered_, -1, moved_);
  pressures_->displace(moved_);
  parallel_for(moved_.size(), [&](std::size_t n) { dx[n] += moved_[n]; });
  project(dx);
  model_.tissue.place_hanging(dx);
}

bool KrylovDirections::follow_contacts(const Iterate& at) {
  if (factor_ != nullptr) return border_.follow(at, *factor_);
  // A solve for each that has changed is too much. The multigrid has the node's own stiffness along directions that
  // were fixed, which is a preconditioner as long as they are few.
  std::size_t changed = 0;
  for (std::size_t k = 0; k < at.in_contact.size(); ++k) changed += at.in_contact[k] != made_from_.at.in_contact[k];
  return changed <= frames_.size() / 100;
}

void KrylovDirections::set_right_side(const Residual& residual) {
  // The mean weight times a cell's side squared; as it is now, should weights become others on the way.
  double sum = 0;
  for (std::size_t c = 0; c < pressure_weights_.size(); ++c)
    sum += pressure_weights_[c] * std::pow(model_.volumes.targets()[c], 2.0 / 3);
  volume_unit_ = sum / static_cast<double>(std::max<std::size_t>(1, pressure_weights_.size()));

  right_.resize(3 * nodes_ + jacobian_.cells());
  std::ranges::copy(residual.forces, of_nodes(right_).begin());
  project(of_nodes(right_));
  for (std::size_t c = 0; c < jacobian_.cells(); ++c) of_cells(right_)[c] = -volume_unit_ * residual.volume_deficit[c];
}

double KrylovDirections::curvature(const Vector& direction, const Vector& product) const {
  // The product's parts are A dx - J^T dlambda and -volume_unit J dx.
  const std::size_t numbers = 3 * nodes_;
  double sum = parallel_dot(std::span(direction).first(numbers), std::span(product).first(numbers));
  const std::span<const double> pressures = of_cells(direction), rates = of_cells(product);
  for (std::size_t c = 0; c < rates.size(); ++c) {
    const double rate = -rates[c] / volume_unit_;
    sum += rate * (pressures[c] + pressure_weights_[c] * rate);
  }
  return sum;
}

int KrylovDirections::wasted(const ConjugateResidualsReport& report) const {
  const long needed = std::lround(iterations_when_new_ * share_of_solve(report.residual));
  return std::max(0, report.iterations - static_cast<int>(needed));
}

NewtonDirections::Outcome KrylovDirections::find(const Step& step, const Iterate& at, const Residual& residual,
                                                 const Wish& wish, Direction& direction, Cost& cost) {
  linearise(at);
  constexpr ConjugateResidualsReport at_beginning{.residual = 1};
  ConjugateResidualsReport before_new = at_beginning;  // where the solve was when the factor was made
  bool is_new = false;
  const auto renew = [&](const ConjugateResidualsReport& so_far) {
    ++cost.factorisations;
    refresh(step, at);
    is_new = true;
    before_new = so_far;
  };
  if (!has_factor_ || wasted_iterations_ > price_of_factor_ || !follow_contacts(at)) renew(at_beginning);

  // Where energy curves down along some direction, that leads to a saddle, if anywhere, and iterations do not end: far
  // from balance the semidefinite tangent shows the way. Near it Newton's method needs all of the tangent.
  Step here = step;
  bool is_indefinite = false;
  const auto multiply_here = [&](const Vector& p, Vector& q) {
    multiply(here, at, p, q);
    if (residual.force > far_from_balance && !here.semidefinite_tangent && curvature(p, q) < 0) is_indefinite = true;
  };
  const auto go_on = [&](const ConjugateResidualsReport& so_far) {
    if (!is_new && wasted(so_far) > 3 * price_of_factor_) renew(so_far);
    return has_factor_ && !is_indefinite && !(stop_requested_ && stop_requested_());
  };
  ConjugateResidualsReport report;
  while (true) {
    set_right_side(residual);
    report = solver_.solve(
        multiply_here, [&](const Vector& r, Vector& z) { precondition(r, z); }, right_,
        {.tolerance = useful_tolerance(residual, wish)}, go_on, solution_);
    cost.linear_solves += report.iterations;
    if (report.converged) break;
    if (is_indefinite) {
      is_indefinite = false;
      here.semidefinite_tangent = true;
      before_new = at_beginning;
    } else if (!report.interrupted && !is_new) {
      renew(at_beginning);
    } else {
      break;
    }
  }
  if (!has_factor_) return Outcome::singular;
  if (report.interrupted) return Outcome::interrupted;
  // An inexact direction is still one; the line search judges it.
  if (!(report.residual < 0.5)) return Outcome::singular;
  if (is_new) {
    const double share = share_of_solve(report.residual / before_new.residual);
    iterations_when_new_ = static_cast<int>(std::lround((report.iterations - before_new.iterations) / share));
    wasted_iterations_ = 0;
  } else {
    wasted_iterations_ += wasted(report);
  }
  direction.positions.assign(of_nodes(solution_).begin(), of_nodes(solution_).end());
  direction.pressures.assign(of_cells(solution_).begin(), of_cells(solution_).end());
  direction.pressures.resize(at.pressures.size(), 0.0);
  return Outcome::found;
}

}  // namespace plica
