// Common types of Krylov methods, which know a linear system by its products.
#pragma once

#include <functional>
#include <vector>

namespace plica {

using KrylovVector = std::vector<double>;

/// Operator: sets `result` to its product with `vector`; distinct vectors of equal length.
using KrylovOperator = std::function<void(const KrylovVector& vector, KrylovVector& result)>;

struct KrylovReport {
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|, by the recurrence
  bool converged = false;
  bool interrupted = false;
};

/// Stopping rule.
struct KrylovRule {
  double tolerance = 1e-3;  // bound on |b - A x| / |b|
  int most_iterations = 200;
  int most_kept = 30;  // conjugate residuals: kept directions, then restart
};

/// Callback before each iteration; false ends the solve as interrupted.
using KrylovGoOn = std::function<bool(const KrylovReport& so_far)>;

}  // namespace plica
