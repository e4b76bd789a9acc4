// What makes the large positive definite systems of a step easy for a Krylov method: an approximate inverse.
#pragma once

#include <memory>
#include <span>

#include "solver/algebra/block_pattern.hpp"

namespace plica {

/// An approximate inverse of a symmetric positive definite matrix of 3 x 3 blocks, one a node.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;

  /// `values`: the pattern's blocks, nine numbers each, by rows. Where a node is fixed in direction n, that row and
  /// column are projected out, (I - n n^T) A, with d n n^T, d > 0, in the diagonal block.
  /// `near_kernel`: 3 x 6 numbers a node, by rows: the rigid motions (translations; rotations about the body's middle,
  /// scaled to the same size) without the directions in which the node is fixed.
  /// False when the matrix is not positive definite, as far as seen.
  [[nodiscard]] virtual bool factorise(std::span<const float> values, std::span<const float> near_kernel) = 0;

  /// Applies the last approximate inverse in place.
  virtual void solve(std::span<float> x) const = 0;
};

/// Algebraic multigrid, for large matrices: keeps Krylov iterations from growing with size
/// (docs/decisions/0007-multigrid.md). The pattern is analysed here, once; what `factorise` makes depends on its
/// arguments alone. Symmetric and positive definite itself. Up to 2000 nodes it is a factor. Not for two solves at
/// once.
std::unique_ptr<Preconditioner> make_multigrid(const BlockPattern& pattern);

}  // namespace plica
