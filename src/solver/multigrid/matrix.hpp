// Matrix of one multigrid level: square blocks of B unknowns per node, 3 on the finest level and 6 on others.
//
// Symmetric, but stored with complete rows: a product then writes each row once, reads memory in one stream, and is
// bitwise identical for any number of threads. Half of it would save half the memory, but threads would write into the
// same rows.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/block_pattern.hpp"
#include "solver/algebra/rows.hpp"

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
  explicit Matrix(const BlockPattern& pattern, std::span<const int> places = {});

  /// Set the blocks of the pattern, B x B each by rows. False if a diagonal block is not positive definite.
  [[nodiscard]] bool set(std::span<const float> values);

  [[nodiscard]] int nodes() const { return rows_.count(); }
  [[nodiscard]] std::size_t unknowns() const { return std::size_t{B} * static_cast<std::size_t>(nodes()); }
  [[nodiscard]] const Rows& rows() const { return rows_; }
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
  void multiply(std::span<const float> x, std::span<float> y) const;
  /// Compute z = D^-1 r, with D the diagonal blocks.
  void multiply_inverses(std::span<const float> r, std::span<float> z) const;

 private:
  [[nodiscard]] bool invert_diagonal();

  Rows rows_;
  std::vector<int> sources_;  // rows_.columns: block of the pattern, or ~ of it if transposed
  UninitialisedVector<float> values_, inverses_;
};

extern template class Matrix<3>;
extern template class Matrix<6>;

}  // namespace plica::multigrid
