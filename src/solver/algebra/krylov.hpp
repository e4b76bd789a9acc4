// Krylov methods: solvers of linear systems that are known by their products.
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

/// Solve A x = b from x = 0. `precondition` applies an approximate, symmetric positive definite A^-1. Sums have a
/// fixed order: bitwise identical for any number of threads.
KrylovReport conjugate_gradients(const KrylovOperator& multiply, const KrylovOperator& precondition,
                                 const KrylovVector& b, const KrylovRule& rule, const KrylovGoOn& go_on,
                                 KrylovVector& x);

/// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983): solver of A x = b from x = 0, for any matrix;
/// minimises the residual over the kept directions, as in GMRES. `precondition` applies an approximate A^-1, which may
/// change between iterations. Sums have a fixed order: bitwise identical for any number of threads.
class ConjugateResiduals {
 public:
  KrylovReport solve(const KrylovOperator& multiply, const KrylovOperator& precondition, const KrylovVector& b,
                     const KrylovRule& rule, const KrylovGoOn& go_on, KrylovVector& x);

 private:
  // Directions p and products A p (orthonormal); kept to avoid allocations.
  std::vector<KrylovVector> directions_, products_;
  KrylovVector residual_;
};

}  // namespace plica
