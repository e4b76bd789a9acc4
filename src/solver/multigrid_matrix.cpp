#include "solver/multigrid_matrix.hpp"

#include <Eigen/Dense>
#include <cmath>

#include "core/parallel.hpp"

namespace plica::multigrid {

template <int B>
Matrix<B>::Matrix(const BlockPattern& pattern) : pattern_starts_(pattern.starts) {
  const int nodes = pattern.nodes();
  rows_.starts.assign(nodes + 1, 0);
  for (int row = 0; row < nodes; ++row)
    for (int place = pattern.starts[row]; place < pattern.starts[row + 1]; ++place) {
      ++rows_.starts[row + 1];
      if (pattern.columns[place] != row) ++rows_.starts[pattern.columns[place] + 1];
    }
  for (int row = 0; row < nodes; ++row) rows_.starts[row + 1] += rows_.starts[row];
  rows_.columns.resize(rows_.starts.back());
  mirrored_.resize(rows_.columns.size() - pattern.columns.size());
  // The pattern's rows in their order: what a row mirrors comes after its own blocks, and ascending too.
  std::vector<int> next(rows_.starts.begin(), rows_.starts.end() - 1);
  for (int row = 0; row < nodes; ++row)
    for (int place = pattern.starts[row]; place < pattern.starts[row + 1]; ++place) {
      const int column = pattern.columns[place];
      rows_.columns[next[row]++] = column;
      if (column == row) continue;
      const int at = next[column]++;
      rows_.columns[at] = row;
      mirrored_[at - pattern.starts[column + 1]] = place;  // so many blocks of the pattern come before it
    }
  values_.resize(std::size_t{B * B} * rows_.columns.size() + spare);
  inverses_.resize(B * unknowns() + spare);
}

template <int B>
bool Matrix<B>::set(std::span<const float> values) {
  parallel_for(nodes(), [&](std::size_t row) {
    const int own = pattern_starts_[row + 1] - pattern_starts_[row];
    for (int place = rows_.starts[row]; place < rows_.starts[row + 1]; ++place) {
      const int k = place - rows_.starts[row];
      float* to = &values_[std::size_t{B * B} * place];
      if (k < own) {
        const float* from = &values[std::size_t{B * B} * (pattern_starts_[row] + k)];
        for (int i = 0; i < B; ++i)
          for (int j = 0; j < B; ++j) to[B * j + i] = from[B * i + j];
      } else {
        std::copy_n(&values[std::size_t{B * B} * mirrored_[place - pattern_starts_[row + 1]]], B * B, to);
      }
    }
  });
  return invert_diagonal();
}

template <int B>
bool Matrix<B>::invert_diagonal() {
  using Block = Eigen::Matrix<double, B, B>;
  bool definite = true;
#pragma omp parallel for schedule(static) reduction(&& : definite)
  for (int node = 0; node < nodes(); ++node) {
    const int own = pattern_starts_[node + 1] - pattern_starts_[node];
    const Block diagonal =
        Eigen::Map<const Eigen::Matrix<float, B, B>>(block(rows_.starts[node] + own - 1)).template cast<double>();
    const Eigen::LLT<Block> factor(diagonal);
    definite = definite && factor.info() == Eigen::Success && std::isfinite(diagonal.sum());
    Eigen::Map<Eigen::Matrix<float, B, B>> inverse(&inverses_[std::size_t{B * B} * node]);
    inverse = factor.solve(Block::Identity()).template cast<float>();
  }
  return definite;
}

namespace {

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

}  // namespace

// Lanczos's tridiagonal matrix out of the coefficients of conjugate gradients, from a start that has a part of every
// eigenvector. Its largest eigenvalue is found much sooner than by iterating D^-1 A.
template <int B>
double Matrix<B>::largest_eigenvalue() const {
  constexpr int steps = 8;
  std::vector<float> r(unknowns()), z(unknowns()), p(unknowns(), 0.0F), Ap(unknowns());
  unsigned state = 1;
  for (float& value : r) {
    state = state * 1664525U + 1013904223U;
    value = static_cast<float>(state >> 8) / static_cast<float>(1 << 24) - 0.5F;
  }
  Eigen::MatrixXd lanczos = Eigen::MatrixXd::Zero(steps, steps);
  double rz = 0, alpha = 0, first = 0;
  int made = 0;
  for (; made < steps; ++made) {
    parallel_for(nodes(), [&](std::size_t node) {
      float product[B];
      multiply_inverse(static_cast<int>(node), &r[B * node], product);
      for (int i = 0; i < B; ++i) z[B * node + i] = product[i];
    });
    const double previous = rz;
    rz = dot(r, z);
    if (made == 0) first = rz;
    if (!(rz > 1e-12 * first)) break;  // no eigenvectors are left
    const double beta = made == 0 ? 0 : rz / previous;
    parallel_for(p.size(), [&](std::size_t n) { p[n] = z[n] + static_cast<float>(beta) * p[n]; });
    parallel_for(nodes(), [&](std::size_t node) {
      float product[B];
      multiply_row(static_cast<int>(node), p.data(), product);
      for (int i = 0; i < B; ++i) Ap[B * node + i] = product[i];
    });
    if (made > 0) {
      lanczos(made, made) = beta / alpha;
      lanczos(made, made - 1) = lanczos(made - 1, made) = std::sqrt(beta) / alpha;
    }
    const double curvature = dot(p, Ap);
    if (!(curvature > 0)) return -1;
    alpha = rz / curvature;
    lanczos(made, made) += 1 / alpha;
    parallel_for(r.size(), [&](std::size_t n) { r[n] -= static_cast<float>(alpha) * Ap[n]; });
  }
  if (made == 0) return 1;
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(lanczos.topLeftCorner(made, made)).eigenvalues().maxCoeff();
}

template class Matrix<3>;
template class Matrix<6>;

}  // namespace plica::multigrid
