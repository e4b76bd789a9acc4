#include "solver/linear/kept_preconditioner.hpp"

#include <algorithm>
#include <cmath>

#include "core/parallel.hpp"
#include "solver/algebra/block_cholesky.hpp"

namespace plica {
namespace {

constexpr std::size_t most_contact_changes = 32;  // before the factor is recomputed

// gamma times the size of a cell, over the mean stiffness of a node. Large, so that few iterations are left for the
// multipliers; but single precision has to carry A beside it, multigrid finds nearly incompressible cells hard (and has
// ChequerboardFactor for the pressures: twice or half of gamma changes little), and within cells of several elements it
// resists what the exact volumes allow. With a factor, a third takes a fifth more iterations, three times as much no
// fewer.
double regularisation(KeptPreconditioner::Inverse inverse, int parts) {
  if (parts > 1) return 3;
  return inverse == KeptPreconditioner::Inverse::multigrid ? 5 : 150;
}

}  // namespace

KeptPreconditioner::KeptPreconditioner(const Model& model, const LinearisedStep& system, Inverse inverse,
                                       const Step& step)
    : model_(model), system_(system), inverse_(inverse), matrix_(model, step) {
  if (inverse == Inverse::multigrid) {
    preconditioner_ = make_multigrid(matrix_.layout());
  } else {
    auto factor = std::make_unique<BlockCholesky>(matrix_.layout());
    factor_ = factor.get();
    preconditioner_ = std::move(factor);
  }
  // Cells of several elements have nodes inside that feel the difference of any two pressures.
  const bool is_refined = model.tissue.elements.size() >= 2 * model.tissue.cells.size();
  if (inverse == Inverse::multigrid && matrix_.jacobian().sparse_rows() > 0 && !is_refined)
    chequerboards_.emplace(matrix_.jacobian(), model.tissue.free_node_count());
}

void KeptPreconditioner::weigh() {
  const double stiffness = matrix_.mean_diagonal();
  const ConstraintJacobian& J = matrix_.jacobian();
  weights_.clear();
  for (std::size_t row = 0; row < J.rows(); ++row)
    weights_.push_back(regularisation(inverse_, J.part_count(row)) * stiffness / J.gradient_scale(row));
}

bool KeptPreconditioner::make(const Step& step, const Iterate& at) {
  const std::vector<NodeFrame>& frames = system_.frames();
  // The semidefinite part of the tangent serves where all of it is not definite.
  for (const bool semidefinite : {false, true}) {
    Step here = step;
    here.semidefinite_tangent = semidefinite;
    matrix_.assemble(model_, system_.contacts(), here, at);
    weigh();
    if (chequerboards_ && !chequerboards_->factorise(matrix_.jacobian(), matrix_, frames)) continue;
    matrix_.add_constraint_stiffness(model_, at.positions, weights_);
    matrix_.write_projected_blocks(frames, values_);
    if (!preconditioner_->factorise(values_, rigid_motions(at))) continue;
    if (factor_ != nullptr)
      contacts_.begin(model_, system_.contacts(), matrix_, frames, at.in_contact, most_contact_changes);
    border_dense_rows();
    in_contact_ = at.in_contact;
    return true;
  }
  return false;
}

UninitialisedVector<float> KeptPreconditioner::rigid_motions(const Iterate& at) const {
  const std::vector<NodeFrame>& frames = system_.frames();
  Vec3 middle = Vec3::Zero();
  for (std::size_t n = 0; n < frames.size(); ++n) middle += at.positions[n] / static_cast<double>(frames.size());
  double size = 0;
  for (std::size_t n = 0; n < frames.size(); ++n) size = std::max(size, (at.positions[n] - middle).norm());
  UninitialisedVector<float> motions(18 * frames.size());
  parallel_for(frames.size(), [&](std::size_t n) {
    Eigen::Matrix<double, 3, 6> of_node;
    of_node << Mat3::Identity(), -cross_matrix((at.positions[n] - middle) / size);
    for (int j = 0; j < 6; ++j) of_node.col(j) = frames[n].free_part(of_node.col(j));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 6; ++j) motions[18 * n + 6 * i + j] = static_cast<float>(of_node(i, j));
  });
  return motions;
}

bool KeptPreconditioner::follow_contacts(const Iterate& at) {
  if (factor_ != nullptr) return contacts_.follow(at, *factor_);
  // A solve for each that has changed is too much. The multigrid has the node's own stiffness along directions that
  // were fixed, which is a preconditioner as long as they are few.
  std::size_t changed = 0;
  for (std::size_t k = 0; k < at.in_contact.size(); ++k) changed += at.in_contact[k] != in_contact_[k];
  return changed <= system_.frames().size() / 100;
}

void KeptPreconditioner::apply_inverse(std::span<Vec3> x) const {
  if (factor_ != nullptr) return contacts_.solve(*factor_, x);
  single_.resize(3 * x.size());
  parallel_for(x.size(), [&](std::size_t n) {
    for (int i = 0; i < 3; ++i) single_[3 * n + i] = static_cast<float>(x[n][i]);
  });
  preconditioner_->solve(single_);
  parallel_for(x.size(), [&](std::size_t n) {
    for (int i = 0; i < 3; ++i) x[n][i] = single_[3 * n + i];
  });
}

// In place, from forces f and rates g to dx and multipliers, of the sparse rows:
//   dm = -gamma W (g + J dx),  (A + gamma J^T W J) dx = f - gamma J^T W g.
void KeptPreconditioner::apply_sparse(std::span<Vec3> dx, std::span<double> multipliers) const {
  const std::size_t rows = multipliers.size(), free = system_.frames().size();
  // J as in the factor: with another, gamma would carry the difference into directions that hardly resist.
  const ConstraintJacobian& J = matrix_.jacobian();
  parallel_for(rows, [&](std::size_t row) { multipliers[row] *= -weights_[row]; });
  J.add_forces(multipliers, 1, dx);
  system_.project(dx);
  apply_inverse(dx.first(free));
  system_.project(dx);
  model_.tissue.place_hanging(dx);
  J.add_rates(dx, weights_, -1, multipliers);
  if (!chequerboards_) return;
  // What gamma W leaves of the volumes' rates, g + J dx = -dm / (gamma W): p = L^-1 of it, dm -= p, dx -= D^-1 J^T p.
  chequered_.resize(rows);
  parallel_for(rows, [&](std::size_t row) { chequered_[row] = -multipliers[row] / weights_[row]; });
  chequerboards_->solve(chequered_);
  parallel_for(rows, [&](std::size_t row) { multipliers[row] -= chequered_[row]; });
  moved_.resize(free);
  parallel_for(moved_.size(), [&](std::size_t n) { moved_[n].setZero(); });
  J.add_forces(chequered_, -1, moved_);
  chequerboards_->displace(moved_);
  parallel_for(moved_.size(), [&](std::size_t n) { dx[n] += moved_[n]; });
  system_.project(dx);
  model_.tissue.place_hanging(dx);
}

void KeptPreconditioner::border_dense_rows() {
  const ConstraintJacobian& J = system_.jacobian();
  const std::size_t numbers = 3 * model_.tissue.node_count() + J.sparse_rows();
  std::vector<std::vector<double>> rows(J.dense_rows(), std::vector<double>(numbers, 0.0));
  for (std::size_t row = 0; row < rows.size(); ++row) {
    const std::span<Vec3> of_nodes = system_.of_nodes(rows[row]);
    std::ranges::copy(J.dense_row(row), of_nodes.begin());
    system_.project(of_nodes);
  }
  dense_.begin(std::move(rows), [&](std::span<double> x) { apply_sparse(system_.of_nodes(x), system_.of_rows(x)); });
}

void KeptPreconditioner::apply(const KrylovVector& residual, KrylovVector& result) const {
  const std::size_t sparse = matrix_.jacobian().sparse_rows();
  const std::span<const double> units = system_.units();
  result = residual;
  const std::span<double> rows = system_.of_rows(result);
  parallel_for(rows.size(), [&](std::size_t row) { rows[row] /= units[row]; });
  apply_sparse(system_.of_nodes(result), rows.first(sparse));
  if (!dense_.empty())
    dense_.apply(std::span(result).first(result.size() - (rows.size() - sparse)), rows.subspan(sparse));
}

}  // namespace plica
