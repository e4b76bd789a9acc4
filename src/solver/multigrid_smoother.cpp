// The polynomial that is smallest on the upper part of the spectrum of D^-1 A: its degree and how far down it reaches
// are what serves nearly incompressible cells best (docs/decisions/0007-multigrid.md). Degree and reach are the same
// before and after the coarser levels, which makes the whole cycle symmetric.
#include "solver/multigrid_smoother.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace plica::multigrid {
namespace {

constexpr int degree = 4;       // products a smoothing
constexpr double reach = 40;    // eigenvalues from the largest down to this part of it are smoothed
constexpr double margin = 1.1;  // the largest eigenvalue is found from below

constexpr double half = (1 - 1 / reach) / 2, middle = (1 + 1 / reach) / 2;  // of the range, over the largest

}  // namespace

template <int B>
Smoother<B>::Smoother(const Matrix<B>& matrix)
    : matrix_(matrix), direction_(matrix.unknowns()), next_(matrix.unknowns()) {}

template <int B>
bool Smoother<B>::update() {
  largest_ = margin * matrix_.largest_eigenvalue();
  return largest_ > 0 && std::isfinite(largest_);
}

// r -= A direction; next = keep direction + step D^-1 r; x += next.
template <int B>
void Smoother<B>::advance(std::span<const float> direction, double keep, double step, std::span<float> r,
                          std::span<float> x, std::span<float> next) const {
  const auto k = static_cast<float>(keep), s = static_cast<float>(step);
  parallel_for(matrix_.nodes(), [&](std::size_t node) {
    float product[B];
    matrix_.multiply_row(static_cast<int>(node), direction.data(), product);
    for (int i = 0; i < B; ++i) r[B * node + i] -= product[i];
    matrix_.multiply_inverse(static_cast<int>(node), &r[B * node], product);
    for (int i = 0; i < B; ++i) {
      next[B * node + i] = k * direction[B * node + i] + s * product[i];
      x[B * node + i] += next[B * node + i];
    }
  });
}

// All steps of the polynomial after the first.
template <int B>
void Smoother<B>::run(std::span<float> r, std::span<float> x) {
  constexpr double sigma = middle / half;
  double rho = 1 / sigma;
  for (int k = 1; k < degree; ++k) {
    const double next = 1 / (2 * sigma - rho);
    advance(direction_, next * rho, 2 * next / (half * largest_), r, x, next_);
    direction_.swap(next_);
    rho = next;
  }
}

template <int B>
void Smoother<B>::start(std::span<float> r, std::span<float> x) {
  const auto step = static_cast<float>(1 / (middle * largest_));
  parallel_for(matrix_.nodes(), [&](std::size_t node) {
    float product[B];
    matrix_.multiply_inverse(static_cast<int>(node), &r[B * node], product);
    for (int i = 0; i < B; ++i) direction_[B * node + i] = x[B * node + i] = step * product[i];
  });
  run(r, x);
  parallel_for(matrix_.nodes(), [&](std::size_t node) {
    float product[B];
    matrix_.multiply_row(static_cast<int>(node), direction_.data(), product);
    for (int i = 0; i < B; ++i) r[B * node + i] -= product[i];
  });
}

template <int B>
void Smoother<B>::finish(std::span<const float> correction, std::span<float> r, std::span<float> x) {
  parallel_for(x.size(), [&](std::size_t n) { x[n] += correction[n]; });
  advance(correction, 0, 1 / (middle * largest_), r, x, direction_);
  run(r, x);
}

template class Smoother<3>;
template class Smoother<6>;

}  // namespace plica::multigrid
