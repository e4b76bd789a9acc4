// Conjugate gradients for a symmetric positive definite operator.
#pragma once

#include "solver/algebra/krylov.hpp"

namespace plica {

/// Solve A x = b from x = 0. `precondition` applies an approximate, symmetric positive definite A^-1. Sums have a
/// fixed order: bitwise identical for any number of threads.
KrylovReport conjugate_gradients(const KrylovOperator& multiply, const KrylovOperator& precondition,
                                 const KrylovVector& b, const KrylovRule& rule, const KrylovGoOn& go_on,
                                 KrylovVector& x);

}  // namespace plica
