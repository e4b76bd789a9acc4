// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983), for any matrix; minimises the residual over the
// kept directions, as in GMRES.
#pragma once

#include "solver/algebra/krylov.hpp"

namespace plica {

/// Solver of A x = b from x = 0. `precondition` applies an approximate A^-1, which may change between iterations. Sums
/// have a fixed order: bitwise identical for any number of threads.
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
