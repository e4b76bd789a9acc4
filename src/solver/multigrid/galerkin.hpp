// The coarser level's matrix, P^T A P.
#pragma once

#include "solver/multigrid/transfer.hpp"

namespace plica::multigrid {

template <int B>
class Galerkin {
 public:
  Galerkin(const Rows& matrix, const Transfer<B>& transfer);

  [[nodiscard]] const BlockPattern& pattern() const { return pattern_; }
  /// Values of the pattern's blocks, 6 x 6 each by rows. An unknown that has no part in P gets the diagonal 1.
  [[nodiscard]] UninitialisedVector<float> values(const Matrix<B>& matrix, const Transfer<B>& transfer) const;

 private:
  [[nodiscard]] UninitialisedVector<float> times_transfer(const Matrix<B>& matrix, const Transfer<B>& transfer) const;

  Rows product_;  // A P, as far as the blocks on and below the diagonal of P^T A P need it
  BlockPattern pattern_;
};

extern template class Galerkin<3>;
extern template class Galerkin<6>;

}  // namespace plica::multigrid
