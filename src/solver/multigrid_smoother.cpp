// The polynomial that is smallest on the upper part of the spectrum of D^-1 A: its degree and how far down it reaches
// are what serves nearly incompressible cells best (docs/decisions/0007-multigrid.md). Degree and reach are the same
// before and after the coarser levels, which makes the whole cycle symmetric.
#include "solver/multigrid_smoother.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "core/parallel.hpp"

namespace plica::multigrid {
namespace {

constexpr int degree = 4;       // products a smoothing
constexpr double reach = 40;    // eigenvalues from the largest down to this part of it are smoothed
constexpr double margin = 1.1;  // the largest eigenvalue is found from below

constexpr double half = (1 - 1 / reach) / 2, middle = (1 + 1 / reach) / 2;  // of the range, over the largest

// In pieces of a fixed size, so that threads do not change the order of sums.
double dot(std::span<const float> a, std::span<const float> b) {
  constexpr std::size_t piece = 4096;
  std::vector<double> sums((a.size() + piece - 1) / piece, 0.0);
  parallel_for(sums.size(), [&](std::size_t p) {
    for (std::size_t n = p * piece; n < std::min(a.size(), (p + 1) * piece); ++n) sums[p] += double(a[n]) * b[n];
  });
  double sum = 0;
  for (const double of_piece : sums) sum += of_piece;
  return sum;
}

// About the largest eigenvalue of D^-1 A, a few per cent less; -1 when A shows not to be positive definite. That of
// Lanczos's tridiagonal matrix, out of the coefficients of conjugate gradients: much sooner near than a power
// iteration.
template <int B>
double largest_eigenvalue(const Matrix<B>& matrix) {
  constexpr int steps = 8;
  std::vector<float> r(matrix.unknowns()), z(r.size()), p(r.size(), 0.0F), Ap(r.size());
  unsigned state = 1;  // a start that has a part of every eigenvector
  for (float& value : r) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<float>(state >> 8) / static_cast<float>(1 << 24) - 0.5F;
  }
  Eigen::Matrix<double, steps, 1> diagonal = Eigen::Matrix<double, steps, 1>::Zero();
  Eigen::Matrix<double, steps - 1, 1> beside = Eigen::Matrix<double, steps - 1, 1>::Zero();
  double rz = 0, alpha = 0, first = 0;
  for (int k = 0; k < steps; ++k) {
    matrix.multiply_inverses(r, z);
    const double before = rz;
    rz = dot(r, z);
    if (k == 0) first = rz;
    if (!(first > 0)) return -1;
    if (rz <= 1e-12 * first) break;  // no eigenvectors are left
    const double beta = k == 0 ? 0 : rz / before;
    parallel_for(p.size(), [&](std::size_t n) { p[n] = z[n] + static_cast<float>(beta) * p[n]; });
    matrix.multiply(p, Ap);
    if (k > 0) {
      diagonal[k] = beta / alpha;
      beside[k - 1] = std::sqrt(beta) / alpha;
    }
    const double curvature = dot(p, Ap);
    if (!(curvature > 0)) return -1;
    alpha = rz / curvature;
    diagonal[k] += 1 / alpha;
    parallel_for(r.size(), [&](std::size_t n) { r[n] -= static_cast<float>(alpha) * Ap[n]; });
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, steps, steps>> solver;
  return solver.computeFromTridiagonal(diagonal, beside, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

}  // namespace

template <int B>
Smoother<B>::Smoother(const Matrix<B>& matrix)
    : matrix_(matrix), direction_(matrix.unknowns()), next_(matrix.unknowns()) {}

template <int B>
bool Smoother<B>::update() {
  largest_ = margin * plica::multigrid::largest_eigenvalue(matrix_);
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
  matrix_.multiply_inverses(r, direction_);
  parallel_for(x.size(), [&](std::size_t n) { x[n] = direction_[n] *= step; });
  run(r, x);
  matrix_.multiply(direction_, next_);
  parallel_for(r.size(), [&](std::size_t n) { r[n] -= next_[n]; });
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
