// Interface of direct solvers of sparse symmetric systems; the pattern is analysed once, values change.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "solver/algebra/rows.hpp"

namespace plica {

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Order the pattern on and below the diagonal (entries may be missing there); once per topology.
  virtual void analyse(const Rows& lower) = 0;
  /// Factorise values in the order of the pattern, row by row. False if the matrix is singular or memory is
  /// insufficient.
  [[nodiscard]] virtual bool factorise(std::span<const double> values) = 0;
  /// Solve in place with the last factor.
  virtual void solve(std::span<double> right_hand_side) const = 0;
};

/// Make a multifrontal LDL^T solver for symmetric, possibly indefinite matrices (MUMPS, sequential); bitwise
/// reproducible. Choice: docs/decisions/0002-linear-solver.md.
std::unique_ptr<LinearSolver> make_direct_solver();

}  // namespace plica
