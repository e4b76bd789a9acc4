// The matrix of one level of the multigrid: square blocks of B unknowns a node, 3 on the finest level and 6 on others.
//
// Symmetric, but kept with all its rows whole: a product then writes each row once and reads memory in one stream, and
// is the same to the bit for any number of threads. Half of it would take half the memory, and turns to write into
// rows that other threads write.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/block_pattern.hpp"
#include "solver/algebra/rows.hpp"

namespace plica::multigrid {

/// Columns of a block are handled in vectors a little longer than they are; what the last lanes hold (the beginning of
/// the next column) is never looked at. Arrays of blocks therefore end with `spare` numbers more.
template <int B>
inline constexpr int lanes = B == 3 ? 4 : 8;
inline constexpr std::size_t spare = 8;

template <int B>
class Matrix {
 public:
  /// `places` says which row of this matrix each node of the pattern is; without, nodes keep their order.
  explicit Matrix(const BlockPattern& pattern, std::span<const int> places = {});

  /// Takes values of the pattern's blocks, B x B each by rows. False when a diagonal block is not positive definite.
  [[nodiscard]] bool set(std::span<const float> values);

  [[nodiscard]] int nodes() const { return rows_.count(); }
  [[nodiscard]] std::size_t unknowns() const { return std::size_t{B} * static_cast<std::size_t>(nodes()); }
  [[nodiscard]] const Rows& rows() const { return rows_; }
  /// A block of rows().columns, by columns.
  [[nodiscard]] const float* block(int place) const { return &values_[std::size_t{B * B} * place]; }
  /// The inverse of a node's diagonal block.
  [[nodiscard]] const float* inverse(int node) const { return &inverses_[std::size_t{B * B} * node]; }

  /// Row of a node times x.
  void multiply_row(int node, const float* x, float (&product)[B]) const {
    float sums[B][lanes<B>] = {};
    for (int place = rows_.starts[node]; place < rows_.starts[node + 1]; ++place) {
      const float *a = block(place), *from = x + std::size_t{B} * rows_.columns[place];
      __builtin_prefetch(a + 1024);  // 4 kB ahead: a fifth faster than what the processor does by itself
      for (int column = 0; column < B; ++column)
#pragma omp simd
        for (int lane = 0; lane < lanes<B>; ++lane) sums[column][lane] += a[B * column + lane] * from[column];
    }
    for (int i = 0; i < B; ++i) {
      product[i] = sums[0][i];
      for (int column = 1; column < B; ++column) product[i] += sums[column][i];
    }
  }

  /// Inverse of a node's diagonal block times r.
  void multiply_inverse(int node, const float* r, float (&product)[B]) const {
    const float* a = inverse(node);
    float sums[lanes<B>] = {};
    for (int column = 0; column < B; ++column)
#pragma omp simd
      for (int lane = 0; lane < lanes<B>; ++lane) sums[lane] += a[B * column + lane] * r[column];
    for (int i = 0; i < B; ++i) product[i] = sums[i];
  }

  /// y = A x.
  void multiply(std::span<const float> x, std::span<float> y) const;
  /// z = D^-1 r, D the diagonal blocks.
  void multiply_inverses(std::span<const float> r, std::span<float> z) const;

 private:
  [[nodiscard]] bool invert_diagonal();

  Rows rows_;
  std::vector<int> sources_;  // of rows_.columns: the pattern's block, or ~ of it where it is to be transposed
  UninitialisedVector<float> values_, inverses_;
};

extern template class Matrix<3>;
extern template class Matrix<6>;

}  // namespace plica::multigrid
