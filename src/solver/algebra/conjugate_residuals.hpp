// Generalised conjugate residuals (Eisenstat, Elman and Schultz 1983), for any kind of matrix; the residual is the
// least that the directions so far allow, as in GMRES.
#pragma once

#include "solver/algebra/krylov.hpp"

namespace plica {

/// Solves A x = b from x = 0. `precondition` applies an approximate A^-1, which may be another from one iteration to
/// the next. Sums are taken in a fixed order: the same bits for any number of threads.
class ConjugateResiduals {
 public:
  KrylovReport solve(const KrylovOperator& multiply, const KrylovOperator& precondition, const KrylovVector& b,
                     const KrylovRule& rule, const KrylovGoOn& go_on, KrylovVector& x);

 private:
  // p and A p, the latter orthonormal; kept, so that they need no room anew.
  std::vector<KrylovVector> directions_, products_;
  KrylovVector residual_;
};

}  // namespace plica
