// Matrix of one multigrid level: square blocks of B unknowns per node, 3 on the finest level and 6 on others.
//
// Symmetric, but stored with complete rows: a product then writes each row once, reads memory in one stream, and is
// bitwise identical for any number of threads. Half of it would save half the memory, but threads would write into the
// same rows.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/uninitialised.hpp"
#include "solver/algebra/sparse_pattern.hpp"

namespace plica::multigrid {

/// Number of padding values after arrays of blocks: columns of a block are processed in slightly longer vectors, whose
/// last lanes (the beginning of the next column) are ignored.
template <int B>
inline constexpr int lanes = B == 3 ? 4 : 8;
inline constexpr std::size_t spare = 8;

template <int B>
class Matrix {
 public:
  /// Make the matrix for a pattern. `places`: row of each node of the pattern; default: the same order.
  explicit Matrix(const BlockPattern& pattern, std::span<const int> places = {}) {
    const int nodes = pattern.nodes();
    const auto place_of = [&](int node) { return places.empty() ? node : places[node]; };
    const auto for_blocks = [&](const auto& take) {  // those above the diagonal too
      for (int node = 0; node < nodes; ++node)
        for (int block = pattern.starts[node]; block < pattern.starts[node + 1]; ++block) {
          const int row = place_of(node), column = place_of(pattern.columns[block]);
          take(row, column, block);
          if (row != column) take(column, row, ~block);
        }
    };
    rows_.starts.assign(nodes + 1, 0);
    for_blocks([&](int row, int, int) { ++rows_.starts[row + 1]; });
    for (int row = 0; row < nodes; ++row) rows_.starts[row + 1] += rows_.starts[row];
    rows_.columns.resize(rows_.starts.back());
    sources_.resize(rows_.starts.back());
    std::vector<int> next(rows_.starts.begin(), rows_.starts.end() - 1);
    for_blocks([&](int row, int column, int source) {
      int at = next[row]++;  // ascending: those that are greater make room
      for (; at > rows_.starts[row] && rows_.columns[at - 1] > column; --at) {
        rows_.columns[at] = rows_.columns[at - 1];
        sources_[at] = sources_[at - 1];
      }
      rows_.columns[at] = column;
      sources_[at] = source;
    });
    values_.resize(std::size_t{B * B} * rows_.columns.size() + spare);
    inverses_.resize(B * unknowns() + spare);
  }

  /// Set the blocks of the pattern, B x B each by rows. False if a diagonal block is not positive definite.
  [[nodiscard]] bool set(std::span<const float> values) {
    parallel_for(nodes(), [&](std::size_t row) {
      for (int place = rows_.starts[row]; place < rows_.starts[row + 1]; ++place) {
        const int source = sources_[place];
        const float* from = &values[std::size_t{B * B} * (source < 0 ? ~source : source)];
        float* to = &values_[std::size_t{B * B} * place];
        if (source < 0)
          std::copy_n(from, B * B, to);
        else
          for (int i = 0; i < B; ++i)
            for (int j = 0; j < B; ++j) to[B * j + i] = from[B * i + j];
      }
    });
    return invert_diagonal();
  }

  [[nodiscard]] int nodes() const { return rows_.count(); }
  [[nodiscard]] std::size_t unknowns() const { return std::size_t{B} * static_cast<std::size_t>(nodes()); }
  [[nodiscard]] const SparsePattern& rows() const { return rows_; }
  /// Return a block of rows().columns, by columns.
  [[nodiscard]] const float* block(int place) const { return &values_[std::size_t{B * B} * place]; }
  /// Return the inverse of the diagonal block of a node.
  [[nodiscard]] const float* inverse(int node) const { return &inverses_[std::size_t{B * B} * node]; }

  /// Return the row of a node times x.
  void multiply_row(int node, const float* x, float (&product)[B]) const {
    float sums[B][lanes<B>] = {};
    for (int place = rows_.starts[node]; place < rows_.starts[node + 1]; ++place) {
      const float *a = block(place), *from = x + std::size_t{B} * rows_.columns[place];
      __builtin_prefetch(a + 1024);  // 4 kB ahead: a fifth faster than hardware prefetching
      for (int column = 0; column < B; ++column)
#pragma omp simd
        for (int lane = 0; lane < lanes<B>; ++lane) sums[column][lane] += a[B * column + lane] * from[column];
    }
    for (int i = 0; i < B; ++i) {
      product[i] = sums[0][i];
      for (int column = 1; column < B; ++column) product[i] += sums[column][i];
    }
  }

  /// Return the inverse of the diagonal block of a node times r.
  void multiply_inverse(int node, const float* r, float (&product)[B]) const {
    const float* a = inverse(node);
    float sums[lanes<B>] = {};
    for (int column = 0; column < B; ++column)
#pragma omp simd
      for (int lane = 0; lane < lanes<B>; ++lane) sums[lane] += a[B * column + lane] * r[column];
    for (int i = 0; i < B; ++i) product[i] = sums[i];
  }

  /// Compute y = A x.
  void multiply(std::span<const float> x, std::span<float> y) const {
    parallel_for(nodes(), [&](std::size_t node) {
      float product[B];
      multiply_row(static_cast<int>(node), x.data(), product);
      for (int i = 0; i < B; ++i) y[B * node + i] = product[i];
    });
  }
  /// Compute z = D^-1 r, with D the diagonal blocks.
  void multiply_inverses(std::span<const float> r, std::span<float> z) const {
    parallel_for(nodes(), [&](std::size_t node) {
      float product[B];
      multiply_inverse(static_cast<int>(node), &r[B * node], product);
      for (int i = 0; i < B; ++i) z[B * node + i] = product[i];
    });
  }

 private:
  [[nodiscard]] bool invert_diagonal() {
    using Block = Eigen::Matrix<double, B, B>;
    bool definite = true;
#pragma omp parallel for schedule(static) reduction(&& : definite)
    for (int node = 0; node < nodes(); ++node) {
      const auto columns = rows_.of(node);
      const auto own = std::ranges::lower_bound(columns, node) - columns.begin();
      const Block diagonal =
          Eigen::Map<const Eigen::Matrix<float, B, B>>(block(rows_.starts[node] + static_cast<int>(own)))
              .template cast<double>();
      const Eigen::LLT<Block> factor(diagonal);
      definite = definite && factor.info() == Eigen::Success;
      Eigen::Map<Eigen::Matrix<float, B, B>> inverse(&inverses_[std::size_t{B * B} * node]);
      inverse = factor.solve(Block::Identity()).template cast<float>();
    }
    return definite;
  }

  SparsePattern rows_;
  std::vector<int> sources_;  // rows_.columns: block of the pattern, or ~ of it if transposed
  UninitialisedVector<float> values_, inverses_;
};

}  // namespace plica::multigrid
