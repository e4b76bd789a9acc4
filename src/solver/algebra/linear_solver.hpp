// Interfaces of direct solvers of sparse symmetric systems, and of preconditioners: approximate inverses of the large
// positive definite systems of a step. The pattern is analysed once, values change.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "solver/algebra/sparse_pattern.hpp"

namespace plica {

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Order the pattern on and below the diagonal (entries may be missing there); once per topology.
  virtual void analyse(const SparsePattern& lower) = 0;
  /// Factorise values in the order of the pattern, row by row. False if the matrix is singular or memory is
  /// insufficient.
  [[nodiscard]] virtual bool factorise(std::span<const double> values) = 0;
  /// Solve in place with the last factor.
  virtual void solve(std::span<double> right_hand_side) const = 0;
};

/// Make a multifrontal LDL^T solver for symmetric, possibly indefinite matrices (MUMPS, sequential); bitwise
/// reproducible. Choice: docs/decisions/0002-linear-solver.md.
std::unique_ptr<LinearSolver> make_direct_solver();

/// Approximate inverse of a symmetric positive definite matrix of 3 x 3 blocks, one per node.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;

  /// Compute the approximate inverse. `values`: blocks of the pattern, nine numbers each, by rows. If a node is fixed
  /// in direction n, that row and column are projected out, (I - n n^T) A, with d n n^T, d > 0, in the diagonal block.
  /// `near_kernel`: 3 x 6 numbers per node, by rows: the rigid motions (translations; rotations about the centre of the
  /// body, scaled to equal size) without fixed directions. False if the matrix is found not to be positive definite.
  [[nodiscard]] virtual bool factorise(std::span<const float> values, std::span<const float> near_kernel) = 0;

  /// Apply the last approximate inverse in place.
  virtual void solve(std::span<float> x) const = 0;
};

/// Make an algebraic multigrid preconditioner for large matrices, whose Krylov iterations do not grow with size
/// (docs/decisions/0007-multigrid.md). Analyses the pattern once; `factorise` depends on its arguments only. Symmetric
/// and positive definite. Up to 2000 nodes it is a factor. Not for simultaneous solves.
std::unique_ptr<Preconditioner> make_multigrid(const BlockPattern& pattern);

}  // namespace plica
