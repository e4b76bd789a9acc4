// Galerkin matrix of the coarser level, P^T A P.
#pragma once

#include "solver/multigrid/transfer.hpp"

namespace plica::multigrid {

template <int B>
class Galerkin {
 public:
  Galerkin(const Rows& matrix, const Transfer<B>& transfer);

  [[nodiscard]] const BlockPattern& pattern() const { return pattern_; }
  /// Return the values of the blocks of the pattern, 6 x 6 each by rows. Unknowns without part in P get the diagonal
  /// 1.
  [[nodiscard]] UninitialisedVector<float> values(const Matrix<B>& matrix, const Transfer<B>& transfer) const;

 private:
  [[nodiscard]] UninitialisedVector<float> times_transfer(const Matrix<B>& matrix, const Transfer<B>& transfer) const;

  Rows product_;  // A P, as required for the lower triangle of P^T A P
  BlockPattern pattern_;
};

extern template class Galerkin<3>;
extern template class Galerkin<6>;

}  // namespace plica::multigrid
