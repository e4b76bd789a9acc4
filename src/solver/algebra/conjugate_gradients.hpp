// Conjugate gradients for a symmetric positive definite operator.
#pragma once

#include "solver/algebra/krylov.hpp"

namespace plica {

/// Solves A x = b from x = 0. `precondition` applies an approximate A^-1, symmetric positive definite. Sums are taken
/// in a fixed order: the same bits for any number of threads.
KrylovReport conjugate_gradients(const KrylovOperator& multiply, const KrylovOperator& precondition,
                                 const KrylovVector& b, const KrylovRule& rule, const KrylovGoOn& go_on,
                                 KrylovVector& x);

}  // namespace plica
