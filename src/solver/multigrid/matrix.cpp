#include "solver/multigrid/matrix.hpp"

#include <Eigen/Dense>

#include "core/parallel.hpp"

namespace plica::multigrid {

template <int B>
Matrix<B>::Matrix(const BlockPattern& pattern, std::span<const int> places) {
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

template <int B>
bool Matrix<B>::set(std::span<const float> values) {
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

template <int B>
bool Matrix<B>::invert_diagonal() {
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
