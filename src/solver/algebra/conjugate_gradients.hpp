// Conjugate gradients for a symmetric positive definite operator that is known by its products only.
#pragma once

#include <functional>

#include "core/vector.hpp"

namespace plica {

struct ConjugateGradientsReport {
  int iterations = 0;
  double residual = 0;  // |b - A x| / |b|, as the recurrence has it
  bool converged = false;
  bool interrupted = false;
};

/// Solves A x = b from x = 0. `multiply(p, Ap)` sets Ap; `precondition(r, z)` sets z to an approximate A^-1 r,
/// symmetric positive definite. Sums are taken in a fixed order: the same bits for any number of threads.
ConjugateGradientsReport conjugate_gradients(const std::function<void(const Vectors&, Vectors&)>& multiply,
                                             const std::function<void(const Vectors&, Vectors&)>& precondition,
                                             const Vectors& b, double tolerance, int most_iterations,
                                             const std::function<bool()>& stop_requested, Vectors& x);

}  // namespace plica
