// Chebyshev smoothing with the inverses of the diagonal blocks.
#pragma once

#include "solver/multigrid_matrix.hpp"

namespace plica::multigrid {

template <int B>
class Smoother {
 public:
  explicit Smoother(const Matrix<B>& matrix);

  /// After the matrix has been set. False when it shows not to be positive definite.
  [[nodiscard]] bool update();
  [[nodiscard]] double largest_eigenvalue() const { return largest_; }

  /// x = about A^-1 r, and r becomes r - A x.
  void start(std::span<float> r, std::span<float> x);
  /// x, of which r is the residual, gets the correction and is smoothed. r is used up.
  void finish(std::span<const float> correction, std::span<float> r, std::span<float> x);

 private:
  void advance(std::span<const float> direction, double keep, double step, std::span<float> r, std::span<float> x,
               std::span<float> next) const;
  void run(std::span<float> r, std::span<float> x);

  const Matrix<B>& matrix_;
  double largest_ = 0;
  std::vector<float> direction_, next_;
};

extern template class Smoother<3>;
extern template class Smoother<6>;

}  // namespace plica::multigrid
