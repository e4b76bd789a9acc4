// A direct solver of sparse symmetric systems behind one interface; the pattern is analysed once, values change.
#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace plica {

/// Places of the lower triangle's entries, 0-based, each once; the diagonal may be missing.
struct SymmetricPattern {
  int size = 0;
  std::vector<int> rows, columns;
};

class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Orders the pattern. Once a topology.
  virtual void analyse(const SymmetricPattern& pattern) = 0;
  /// Factorises; values in the pattern's order. False when the matrix is singular or memory runs out.
  [[nodiscard]] virtual bool factorise(std::span<const double> values) = 0;
  /// Solves in place with the last factor.
  virtual void solve(std::span<double> right_hand_side) const = 0;
};

/// Multifrontal LDL^T of a symmetric, possibly indefinite matrix (MUMPS, sequential). Same bits on every call.
/// Why this one: docs/decisions/0002-linear-solver.md.
std::unique_ptr<LinearSolver> make_direct_solver();

}  // namespace plica
