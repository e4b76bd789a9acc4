// Chebyshev smoothing with the inverses of the diagonal blocks, and an order of nodes with small distances between
// neighbours, so that its products can follow one another through memory.
//
// The polynomial that is smallest on the upper part of the spectrum of D^-1 A: its degree and how far down it reaches
// are what serves nearly incompressible cells best (docs/decisions/0007-multigrid.md). Degree and reach are the same
// before and after the coarser levels, which makes the whole cycle symmetric.
#pragma once

#include <array>
#include <cmath>

#include "solver/multigrid/matrix.hpp"

namespace plica::multigrid {

// Appends the nodes that can be reached from the first, by their distance.
inline void walk(const SparsePattern& neighbours, int first, std::vector<char>& seen, std::vector<int>& order) {
  std::size_t next = order.size();
  order.push_back(first);
  for (seen[first] = 1; next < order.size(); ++next)
    for (const int node : neighbours.of(order[next])) {
      if (seen[node]) continue;
      seen[node] = 1;
      order.push_back(node);
    }
}

/// Return the place of each node, sorted by distance (in neighbours) from a node at one end of the mesh: rings about
/// the axis of an embryo.
inline std::vector<int> places_by_distance(const BlockPattern& pattern) {
  const SparsePattern neighbours = neighbours_of(pattern);
  std::vector<int> order, places(pattern.nodes());
  std::vector<char> seen(pattern.nodes(), 0);
  for (int node = 0; node < pattern.nodes(); ++node) {
    if (seen[node]) continue;
    const std::size_t begin = order.size();
    walk(neighbours, node, seen, order);
    const int end = order.back();  // the farthest is at an end; from there once more
    for (std::size_t k = begin; k < order.size(); ++k) seen[order[k]] = 0;
    order.resize(begin);
    walk(neighbours, end, seen, order);
  }
  for (int place = 0; place < pattern.nodes(); ++place) places[order[place]] = place;
  return places;
}

/// Return the bounds of consecutive groups of at least `least` rows (fewer in the last), such that all columns of the
/// rows of a group lie in it or in the two adjacent groups. If neighbours are far apart, there are few groups.
inline std::vector<int> groups_of_rows(const SparsePattern& matrix, int least) {
  std::vector<int> bounds{0};
  int row = 0, reach = 0;  // of the rows before it
  while (bounds.back() < matrix.count()) {
    bounds.push_back(std::min(matrix.count(), std::max(reach, bounds.back() + least)));
    for (; row < bounds.back(); ++row)
      if (!matrix.of(row).empty()) reach = std::max(reach, matrix.of(row).back() + 1);
  }
  return bounds;
}

// In pieces of a fixed size, so that threads do not change the order of sums.
inline double dot(std::span<const float> a, std::span<const float> b) {
  constexpr std::size_t piece = 4096, worth_sharing = 16;
  std::vector<double> sums((a.size() + piece - 1) / piece);
  parallel_for(
      sums.size(),
      [&](std::size_t p) {
        double sum = 0;
        const std::size_t last = std::min(a.size(), (p + 1) * piece);
#pragma omp simd reduction(+ : sum)
        for (std::size_t n = p * piece; n < last; ++n) sum += double(a[n]) * b[n];
        sums[p] = sum;
      },
      worth_sharing);
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

// Calls sweep(k, row) for every row and every k, in an order in which sweep k finds what sweep k - 1 wrote for the row
// and its neighbours: group after group of rows, each sweep one group behind the last. So the matrix comes from memory
// once for all of them. Rows do not depend on others of the same sweep, hence no bit on the threads.
template <class Sweep>
void for_sweeps(std::span<const int> groups, int sweeps, const Sweep& sweep) {
  constexpr int worth_sharing = 4096;  // rows
  const int count = static_cast<int>(groups.size()) - 1;
#pragma omp parallel if (groups.back() >= worth_sharing)
  for (int front = 0; front < count + sweeps - 1; ++front)
    for (int k = std::max(0, front - count + 1); k <= std::min(front, sweeps - 1); ++k)
#pragma omp for schedule(static)
      for (int row = groups[front - k]; row < groups[front - k + 1]; ++row) sweep(k, row);
}

template <int B>
class Smoother {
 public:
  explicit Smoother(const Matrix<B>& matrix)
      : matrix_(matrix),
        groups_(groups_of_rows(matrix.rows(), rows_a_group)),
        directions_{UninitialisedVector<float>(matrix.unknowns()), UninitialisedVector<float>(matrix.unknowns())} {}

  /// Prepare smoothing after the matrix has been set. False if it is found not to be positive definite.
  [[nodiscard]] bool update() {
    largest_ = margin * plica::multigrid::largest_eigenvalue(matrix_);
    constexpr double sigma = middle / half;
    double rho = 1 / sigma;
    terms_[0] = {0, static_cast<float>(1 / (middle * largest_))};
    for (int k = 1; k < degree; ++k) {
      const double next = 1 / (2 * sigma - rho);
      terms_[k] = {static_cast<float>(next * rho), static_cast<float>(2 * next / (half * largest_))};
      rho = next;
    }
    return largest_ > 0 && std::isfinite(largest_);
  }
  [[nodiscard]] double largest_eigenvalue() const { return largest_; }

  /// Set x to about A^-1 r, and r to r - A x.
  void start(std::span<float> r, std::span<float> x) {
    for_sweeps(groups_, degree + 1, [&](int k, int node) {
      const std::size_t at = std::size_t{B} * node;
      const float* before = directions_[(k + 1) % 2].data();
      float product[B];
      if (k == 0) {
        matrix_.multiply_inverse(node, &r[at], product);
        for (int i = 0; i < B; ++i) x[at + i] = directions_[0][at + i] = terms_[0].step * product[i];
      } else if (k < degree) {
        advance(node, terms_[k], before, r.data(), x.data(), directions_[k % 2].data());
      } else {
        matrix_.multiply_row(node, before, product);
        for (int i = 0; i < B; ++i) r[at + i] -= product[i];
      }
    });
  }
  /// Correct and smooths x, whose residual is r; r is overwritten.
  void finish(std::span<const float> correction, std::span<float> r, std::span<float> x) {
    for_sweeps(groups_, degree, [&](int k, int node) {
      const std::size_t at = std::size_t{B} * node;
      if (k == 0)
        for (int i = 0; i < B; ++i) x[at + i] += correction[at + i];
      const float* before = k == 0 ? correction.data() : directions_[(k + 1) % 2].data();
      advance(node, terms_[k], before, r.data(), x.data(), directions_[k % 2].data());
    });
  }

 private:
  static constexpr int rows_a_group = 2048;  // so that those that are at work at once stay in a cache
  static constexpr double reach = 40;        // eigenvalues from the largest down to this part of it are smoothed
  static constexpr double margin = 1.1;      // the largest eigenvalue is found from below
  static constexpr double half = (1 - 1 / reach) / 2, middle = (1 + 1 / reach) / 2;  // of the range, over the largest
  static constexpr int degree = 4;                                                   // products per smoothing
  struct Term {
    float keep, step;
  };
  // r -= A direction; next = keep direction + step D^-1 r; x += next. Of one node.
  void advance(int node, Term term, const float* direction, float* r, float* x, float* next) const {
    const std::size_t at = std::size_t{B} * node;
    float product[B];
    matrix_.multiply_row(node, direction, product);
    for (int i = 0; i < B; ++i) r[at + i] -= product[i];
    matrix_.multiply_inverse(node, r + at, product);
    for (int i = 0; i < B; ++i) {
      next[at + i] = term.keep * direction[at + i] + term.step * product[i];
      x[at + i] += next[at + i];
    }
  }

  const Matrix<B>& matrix_;
  std::vector<int> groups_;
  double largest_ = 0;
  std::array<Term, degree> terms_{};
  std::array<UninitialisedVector<float>, 2> directions_;  // used alternately
};

}  // namespace plica::multigrid
