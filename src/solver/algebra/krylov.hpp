// What Krylov's methods have in common: a linear system that is known by its products only.
#pragma once

#include <functional>
#include <vector>

namespace plica {

using KrylovVector = std::vector<double>;

/// Sets `result` to the operator's product with `vector`. They are different vectors of equal length.
using KrylovOperator = std::function<void(const KrylovVector& vector, KrylovVector& result)>;

struct KrylovReport {
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|, as the recurrence has it
  bool converged = false;
  bool interrupted = false;
};

/// When to stop.
struct KrylovRule {
  double tolerance = 1e-3;  // of |b - A x| / |b|
  int most_iterations = 200;
  int most_kept = 30;  // directions that are kept; then it begins anew. Of conjugate residuals
};

/// Asked before each iteration; once false, the solve ends as interrupted.
using KrylovGoOn = std::function<bool(const KrylovReport& so_far)>;

}  // namespace plica
