// Approximate inverse of the linear system of a Newton iteration, computed at one iterate and kept over steps: that of
//   [ A             -J^T          ]
//   [ -J   -(gamma W)^-1          ],  W = 1/gradient_scale,
// in which multipliers are eliminated: A + gamma J^T W J is positive definite, and its factor (or multigrid) is in
// single precision. Later changes of contacts are borders (border.hpp), as dense rows always are. Derivation:
// docs/theory/step.md, Linear systems.
#pragma once

#include <algorithm>
#include <memory>
#include <optional>
#include <vector>

#include "core/parallel.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/algebra/krylov.hpp"
#include "solver/linear/border.hpp"
#include "solver/linear/chequerboard_factor.hpp"
#include "solver/linear/directions.hpp"
#include "solver/linear/linearised_system.hpp"

namespace plica {

class KeptPreconditioner {
 public:
  /// Make a preconditioner of `system`, for steps with the patterns of `step`. `before`: that of earlier patterns,
  /// whose order of elimination serves if it suits these; or null.
  KeptPreconditioner(const Model& model, const LinearisedSystem& system, LinearMethod method, const Step& step,
                     const KeptPreconditioner* before)
      : model_(model), system_(system), method_(method), matrix_(model, step) {
    if (method == LinearMethod::multigrid) {
      preconditioner_ = make_multigrid(matrix_.layout());
    } else {
      auto factor = make_factor(before);
      factor_ = factor.get();
      preconditioner_ = std::move(factor);
    }
    // Cells of several elements have nodes inside that feel the difference of any two pressures.
    const bool is_refined = model.tissue.elements.size() >= 2 * model.tissue.cells.size();
    if (method == LinearMethod::multigrid && matrix_.jacobian().sparse_rows() > 0 && !is_refined)
      chequerboards_.emplace(matrix_.jacobian(), model.tissue.free_node_count());
  }

  /// Whether the order of elimination is that of earlier patterns.
  [[nodiscard]] bool has_borrowed_order() const { return size_when_ordered_.has_value(); }

  /// Whether the patterns of the laws are unchanged.
  [[nodiscard]] bool serves(const Step& step) const { return matrix_.serves(model_, step); }

  /// Recompute it at the present iterate of the system. False, and it is unusable, if no nearby matrix is positive
  /// definite.
  [[nodiscard]] bool make(const Step& step, const Iterate& at) {
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
        contacts_.begin(model_, system_.contacts(), matrix_, frames, at.on_obstacle,
                        most_obstacle_changes(frames.size()));
      border_dense_rows();
      on_obstacle_ = at.on_obstacle;
      return true;
    }
    return false;
  }

  /// Add changes of contacts since. False if it must be recomputed.
  [[nodiscard]] bool follow_contacts(const Iterate& at) {
    if (factor_ != nullptr) return contacts_.follow(at, *factor_);
    // One solve per changed contact would be too expensive. Multigrid uses the own stiffness of a node along formerly
    // fixed directions, which preconditions well while they are few.
    std::size_t changed = 0;
    for (std::size_t k = 0; k < at.on_obstacle.size(); ++k) changed += at.on_obstacle[k] != on_obstacle_[k];
    return changed <= system_.frames().size() / 100;
  }

  /// Update the dense rows at the present iterate, one solve each. (With those of an older iterate, held exactly,
  /// solves took five more iterations.)
  void border_dense_rows() {
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

  void apply(const KrylovVector& residual, KrylovVector& result) const {
    const std::size_t sparse = matrix_.jacobian().sparse_rows();
    const std::span<const double> units = system_.units();
    result = residual;
    const std::span<double> rows = system_.of_rows(result);
    parallel_for(rows.size(), [&](std::size_t row) { rows[row] /= units[row]; });
    apply_sparse(system_.of_nodes(result), rows.first(sparse));
    if (!dense_.empty())
      dense_.apply(std::span(result).first(result.size() - (rows.size() - sparse)), rows.subspan(sparse));
  }

  /// Return gamma W of the rows, a force over a length squared, divided by gradient_scale. For dense rows only a unit.
  [[nodiscard]] std::span<const double> weights() const { return weights_; }

 private:
  // Changed contacts for which a factor is kept. A new one takes ever longer, compared with a border, the larger it is.
  static std::size_t most_obstacle_changes(std::size_t nodes) { return nodes <= 20'000 ? 32 : 512; }
  // gamma times the size of a cell, relative to the mean stiffness of a node. A large value saves iterations for the
  // multipliers. Its limits: single precision must resolve A beside it; multigrid converges slowly on nearly
  // incompressible cells (and has ChequerboardFactor for pressures, so a factor of 2 changes little); where each
  // element of a cell resists, it opposes motions that exact volumes allow. With a factor, a third of it costs a fifth
  // more iterations; three times as much saves none.
  static double regularisation(LinearMethod method, bool is_joined) {
    if (!is_joined) return 3;
    return method == LinearMethod::multigrid ? 5 : 150;
  }
  // Where contacts have come and gone, an earlier order does nearly as well, and METIS takes longer than all the rest.
  std::unique_ptr<BlockCholesky> make_factor(const KeptPreconditioner* before) {
    constexpr double most_growth = 1.1;
    if (before != nullptr && before->factor_ != nullptr) {
      const double size = before->size_when_ordered_.value_or(static_cast<double>(before->factor_->factor_size()));
      auto factor = std::make_unique<BlockCholesky>(matrix_.layout(), chosen_kernels(), before->factor_->positions());
      if (static_cast<double>(factor->factor_size()) <= most_growth * size) {
        size_when_ordered_ = size;
        return factor;
      }
    }
    return std::make_unique<BlockCholesky>(matrix_.layout());
  }
  void weigh() {
    const double stiffness = matrix_.mean_diagonal();
    const ConstraintJacobian& J = matrix_.jacobian();
    weights_.clear();
    for (std::size_t row = 0; row < J.rows(); ++row)
      weights_.push_back(regularisation(method_, row >= J.sparse_rows() || J.is_joined(row)) * stiffness /
                         J.gradient_scale(row));
  }
  [[nodiscard]] UninitialisedVector<float> rigid_motions(const Iterate& at) const {
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
  void apply_inverse(std::span<Vec3> x) const {
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
  void apply_sparse(std::span<Vec3> dx, std::span<double> multipliers) const {
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

  const Model& model_;
  const LinearisedSystem& system_;
  LinearMethod method_;  // cholesky or multigrid
  SystemMatrix matrix_;  // with its J, at the iterate of the inverse
  std::unique_ptr<Preconditioner> preconditioner_;
  const BlockCholesky* factor_ = nullptr;    // the factor, if it is one, with its border
  std::optional<double> size_when_ordered_;  // of the factor that a borrowed order was made for
  ObstacleBorder contacts_;
  std::optional<ChequerboardFactor> chequerboards_;  // for modes that gamma W does not resist
  DenseBorder dense_;
  std::vector<char> on_obstacle_;  // contacts at the iterate of the inverse
  std::vector<double> weights_;    // rows

  mutable std::vector<double> chequered_;  // scratch
  mutable Vectors moved_;
  mutable std::vector<float> single_;
  UninitialisedVector<float> values_;
};

}  // namespace plica
