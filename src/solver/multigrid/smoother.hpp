// Chebyshev smoothing with the inverses of the diagonal blocks.
#pragma once

#include <array>

#include "solver/multigrid/matrix.hpp"

namespace plica::multigrid {

template <int B>
class Smoother {
 public:
  explicit Smoother(const Matrix<B>& matrix);

  /// Prepare smoothing after the matrix has been set. False if it is found not to be positive definite.
  [[nodiscard]] bool update();
  [[nodiscard]] double largest_eigenvalue() const { return largest_; }

  /// Set x to about A^-1 r, and r to r - A x.
  void start(std::span<float> r, std::span<float> x);
  /// Correct and smooths x, whose residual is r; r is overwritten.
  void finish(std::span<const float> correction, std::span<float> r, std::span<float> x);

 private:
  static constexpr int degree = 4;  // products per smoothing
  struct Term {
    float keep, step;
  };
  void advance(int node, Term term, const float* direction, float* r, float* x, float* next) const;

  const Matrix<B>& matrix_;
  std::vector<int> groups_;
  double largest_ = 0;
  std::array<Term, degree> terms_{};
  std::array<UninitialisedVector<float>, 2> directions_;  // used alternately
};

extern template class Smoother<3>;
extern template class Smoother<6>;

}  // namespace plica::multigrid
