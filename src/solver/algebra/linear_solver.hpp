// A direct solver of sparse symmetric systems behind one interface; the pattern is analysed once, values change.
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
  /// Orders the pattern on and below the diagonal, which may be missing. Once a topology.
  virtual void analyse(const Rows& lower) = 0;
  /// Factorises; values in the pattern's order, row by row. False when the matrix is singular or memory runs out.
  [[nodiscard]] virtual bool factorise(std::span<const double> values) = 0;
  /// Solves in place with the last factor.
  virtual void solve(std::span<double> right_hand_side) const = 0;
};

/// Multifrontal LDL^T of a symmetric, possibly indefinite matrix (MUMPS, sequential). Same bits on every call.
/// Why this one: docs/decisions/0002-linear-solver.md.
std::unique_ptr<LinearSolver> make_direct_solver();

}  // namespace plica
