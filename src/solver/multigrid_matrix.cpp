#include "solver/multigrid_matrix.hpp"

#include <Eigen/Dense>

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
    definite = definite && factor.info() == Eigen::Success;
    Eigen::Map<Eigen::Matrix<float, B, B>> inverse(&inverses_[std::size_t{B * B} * node]);
    inverse = factor.solve(Block::Identity()).template cast<float>();
  }
  return definite;
}

template <int B>
void Matrix<B>::multiply(std::span<const float> x, std::span<float> y) const {
  parallel_for(nodes(), [&](std::size_t node) {
    float product[B];
    multiply_row(static_cast<int>(node), x.data(), product);
    for (int i = 0; i < B; ++i) y[B * node + i] = product[i];
  });
}

template <int B>
void Matrix<B>::multiply_inverses(std::span<const float> r, std::span<float> z) const {
  parallel_for(nodes(), [&](std::size_t node) {
    float product[B];
    multiply_inverse(static_cast<int>(node), &r[B * node], product);
    for (int i = 0; i < B; ++i) z[B * node + i] = product[i];
  });
}

template class Matrix<3>;
template class Matrix<6>;

}  // namespace plica::multigrid
