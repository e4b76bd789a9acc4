#include "solver/multigrid/galerkin.hpp"

#include "core/parallel.hpp"

namespace plica::multigrid {
namespace {

constexpr int wide = lanes<motions>;

}  // namespace

template <int B>
Galerkin<B>::Galerkin(const Rows& matrix, const Transfer<B>& transfer)
    : product_(collect_rows(matrix.count(), [&](int node, const auto& take) {
        const auto own = transfer.rows().of(node);
        if (own.empty()) return;
        for (const int n : matrix.of(node))
          for (const int column : transfer.rows().of(n))
            if (column <= own.back()) take(column);
      })) {
  const auto& columns = transfer.columns();
  Rows rows = collect_rows(transfer.coarse_nodes(), [&](int row, const auto& take) {
    for (int at = columns.starts[row]; at < columns.starts[row + 1]; ++at)
      for (const int column : product_.of(columns.rows[at]))
        if (column <= row) take(column);
  });
  pattern_ = {std::move(rows.starts), std::move(rows.columns)};
}

// Rows of A P, B x 6 a block, by rows.
template <int B>
UninitialisedVector<float> Galerkin<B>::times_transfer(const Matrix<B>& matrix, const Transfer<B>& transfer) const {
  UninitialisedVector<float> values(std::size_t{B * motions} * product_.columns.size() + spare);
  FirstError error;
#pragma omp parallel
  {
    std::vector<float> sums;  // of a row, with room for the lanes
    const auto make_row = [&](int node) {
      const auto columns = product_.of(node);
      sums.assign(B * wide * columns.size(), 0.0F);
      for (int place = matrix.rows().starts[node]; place < matrix.rows().starts[node + 1]; ++place) {
        const int neighbour = matrix.rows().columns[place];
        const float* a = matrix.block(place);
        std::size_t at = 0;  // both rows ascend
        for (int p = transfer.rows().starts[neighbour]; p < transfer.rows().starts[neighbour + 1]; ++p) {
          while (at < columns.size() && columns[at] < transfer.rows().columns[p]) ++at;
          if (at == columns.size()) break;
          float* to = &sums[B * wide * at];
          const float* from = transfer.block(p);
          for (int i = 0; i < B; ++i)
            for (int j = 0; j < B; ++j)
#pragma omp simd
              for (int lane = 0; lane < wide; ++lane) to[wide * i + lane] += a[B * j + i] * from[motions * j + lane];
        }
      }
      float* to = &values[std::size_t{B * motions} * product_.starts[node]];
      for (std::size_t row = 0; row < B * columns.size(); ++row) to = std::copy_n(&sums[wide * row], motions, to);
    };
#pragma omp for schedule(static)
    for (int node = 0; node < matrix.nodes(); ++node) error.take([&] { make_row(node); });
  }
  error.rethrow();
  return values;
}

template <int B>
UninitialisedVector<float> Galerkin<B>::values(const Matrix<B>& matrix, const Transfer<B>& transfer) const {
  const auto product = times_transfer(matrix, transfer);
  UninitialisedVector<float> values(std::size_t{motions * motions} * pattern_.columns.size());
  const auto& of_aggregates = transfer.columns();
  FirstError error;
#pragma omp parallel
  {
    std::vector<float> sums;
    const auto make_row = [&](int row) {
      const auto columns =
          std::span(pattern_.columns).subspan(pattern_.starts[row], pattern_.starts[row + 1] - pattern_.starts[row]);
      sums.assign(motions * wide * columns.size(), 0.0F);
      for (int place = of_aggregates.starts[row]; place < of_aggregates.starts[row + 1]; ++place) {
        const int node = of_aggregates.rows[place];
        const float* p = transfer.block(of_aggregates.places[place]);
        std::size_t at = 0;  // both rows ascend
        for (int k = product_.starts[node]; k < product_.starts[node + 1] && product_.columns[k] <= row; ++k) {
          while (columns[at] < product_.columns[k]) ++at;
          float* to = &sums[motions * wide * at];
          const float* from = &product[std::size_t{B * motions} * k];
          for (int i = 0; i < B; ++i)
            for (int motion = 0; motion < motions; ++motion)
#pragma omp simd
              for (int lane = 0; lane < wide; ++lane)
                to[wide * motion + lane] += p[motions * i + motion] * from[motions * i + lane];
        }
      }
      float* diagonal = &sums[motions * wide * (columns.size() - 1)];
      for (int motion = 0; motion < motions; ++motion)
        if (diagonal[(wide + 1) * motion] == 0) diagonal[(wide + 1) * motion] = 1;
      float* to = &values[std::size_t{motions * motions} * pattern_.starts[row]];
      for (std::size_t k = 0; k < motions * columns.size(); ++k) to = std::copy_n(&sums[wide * k], motions, to);
    };
#pragma omp for schedule(dynamic, 64)
    for (int row = 0; row < pattern_.nodes(); ++row) error.take([&] { make_row(row); });
  }
  error.rethrow();
  return values;
}

template class Galerkin<3>;
template class Galerkin<6>;

}  // namespace plica::multigrid
