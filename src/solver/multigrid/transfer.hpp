// Transfer between a multigrid level and the next coarser one, whose nodes are aggregates with six unknowns each, and
// the matrix of that.
#pragma once

#include <algorithm>
#include <cmath>
#include <utility>

#include "solver/multigrid/matrix.hpp"

namespace plica::multigrid {

/// Number of unknowns of an aggregate: one per rigid motion.
inline constexpr int motions = 6;
inline constexpr double damping = 4.0 / 3;  // w times the largest eigenvalue of D^-1 A

// Six columns of the same length, one after another.
class Columns {
 public:
  explicit Columns(std::size_t length) : length_(length), values_(motions * length) {}
  double& at(std::size_t row, int column) { return values_[length_ * column + row]; }

  double dot(int a, int b) {
    const double *u = &at(0, a), *v = &at(0, b);
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (std::size_t row = 0; row < length_; ++row) sum += u[row] * v[row];
    return sum;
  }
  void add(int to, double factor, int from) {
    double* u = &at(0, to);
    const double* v = &at(0, from);
#pragma omp simd
    for (std::size_t row = 0; row < length_; ++row) u[row] += factor * v[row];
  }
  void scale(int column, double factor) {
    for (std::size_t row = 0; row < length_; ++row) at(row, column) *= factor;
  }

 private:
  std::size_t length_;
  std::vector<double> values_;
};

// Gram-Schmidt in place: Q keeps orthonormal columns, or zero ones for those that depend on columns before. Writes R,
// 6 x 6 by rows: what Q R was.
inline void orthonormalise(Columns& Q, float* R) {
  constexpr double dependent = 1e-5;  // of a column's length is left; rounding of single precision leaves 1e-7
  std::fill_n(R, motions * motions, 0.0F);
  for (int column = 0; column < motions; ++column) {
    const double length = std::sqrt(Q.dot(column, column));
    for (int before = 0; before < column; ++before) {
      const double part = Q.dot(before, column);
      Q.add(column, -part, before);
      R[motions * before + column] = static_cast<float>(part);
    }
    const double left = std::sqrt(Q.dot(column, column));
    const bool independent = left > dependent * length;
    Q.scale(column, independent ? 1 / left : 0);
    R[(motions + 1) * column] = static_cast<float>(independent ? left : 0);
  }
}

// The aggregate in which most of the neighbours are; the lowest where it is a tie.
inline int most_frequent(std::span<const int> neighbours, const std::vector<int>& aggregate_of) {
  std::vector<std::pair<int, int>> counts;
  for (const int n : neighbours) {
    if (aggregate_of[n] == -1) continue;
    const auto found =
        std::find_if(counts.begin(), counts.end(), [&](const auto& c) { return c.first == aggregate_of[n]; });
    if (found == counts.end())
      counts.emplace_back(aggregate_of[n], 1);
    else
      ++found->second;
  }
  int best = -1, most = 0;
  for (const auto& [aggregate, count] : counts)
    if (count > most || (count == most && aggregate < best)) {
      best = aggregate;
      most = count;
    }
  return best;
}

struct Aggregates {
  int count = 0;
  std::vector<int> of_node;  // -1: isolated node, omitted on the coarser level
  SparsePattern members;     // nodes of each aggregate
};

/// Make disjoint neighbourhoods: a node with all its neighbours if none is taken yet; each remaining node joins the
/// aggregate with most of its neighbours. 27 nodes in a lattice of hexahedra, 18 in a sheet of one layer.
inline Aggregates make_aggregates(const SparsePattern& matrix) {
  Aggregates result;
  std::vector<int> first(matrix.count(), -1);
  for (int node = 0; node < matrix.count(); ++node) {
    const auto neighbours = matrix.of(node);  // itself among them
    const bool free = std::all_of(neighbours.begin(), neighbours.end(), [&](int n) { return first[n] == -1; });
    if (!free || neighbours.size() < 2) continue;
    for (const int n : neighbours) first[n] = result.count;
    ++result.count;
  }
  result.of_node = first;
  for (int node = 0; node < matrix.count(); ++node)
    if (first[node] == -1) result.of_node[node] = most_frequent(matrix.of(node), first);

  SparsePattern of_nodes;
  for (const int aggregate : result.of_node) {
    if (aggregate != -1) of_nodes.columns.push_back(aggregate);
    of_nodes.starts.push_back(static_cast<int>(of_nodes.columns.size()));
  }
  Transposed members = transpose(of_nodes, result.count);
  result.members = {std::move(members.starts), std::move(members.rows)};
  return result;
}

/// Smoothed aggregation. T contains, per aggregate, an orthonormal basis of the rigid motions of its nodes; P = (I - w
/// D^-1 A) T is smoother and reaches the neighbouring aggregates. A rigid motion of all nodes is T R, with R the
/// motions of the coarser nodes.
template <int B>
class Transfer {
 public:
  explicit Transfer(const SparsePattern& matrix)
      : aggregates_(make_aggregates(matrix)),
        rows_(collect_pattern(matrix.count(),
                              [&](int node, const auto& take) {
                                for (const int n : matrix.of(node))
                                  if (aggregates_.of_node[n] != -1) take(aggregates_.of_node[n]);
                              })),
        columns_(transpose(rows_, aggregates_.count)),
        values_(std::size_t{B * motions} * rows_.columns.size() + spare) {}

  /// Recompute P. `near_kernel`: B x 6 numbers per node, by rows; replaced by that of the coarser level, 6 x 6 per
  /// node. If an aggregate has fewer than six independent motions, the surplus unknowns have no part in P.
  void update(const Matrix<B>& matrix, double largest_eigenvalue, UninitialisedVector<float>& near_kernel) {
    const auto T = tentative(near_kernel);
    const auto weight = static_cast<float>(damping / largest_eigenvalue);
    constexpr int wide = lanes<motions>;
    parallel_for(matrix.nodes(), [&](std::size_t node) {
      const int own = aggregates_.of_node[node], n = static_cast<int>(node);
      const auto neighbours = matrix.rows().of(n);
      for (int place = rows_.starts[node]; place < rows_.starts[node + 1]; ++place) {
        float AT[B][wide] = {};
        for (std::size_t k = 0; k < neighbours.size(); ++k) {
          if (aggregates_.of_node[neighbours[k]] != rows_.columns[place]) continue;
          const float *a = matrix.block(matrix.rows().starts[node] + static_cast<int>(k)),
                      *t = &T[std::size_t{B * motions} * neighbours[k]];
          for (int i = 0; i < B; ++i)
            for (int j = 0; j < B; ++j)
#pragma omp simd
              for (int lane = 0; lane < wide; ++lane) AT[i][lane] += a[B * j + i] * t[motions * j + lane];
        }
        const float* D = matrix.inverse(n);
        float* to = &values_[std::size_t{B * motions} * place];
        for (int i = 0; i < B; ++i)
          for (int motion = 0; motion < motions; ++motion) {
            float smoothed = 0;
            for (int j = 0; j < B; ++j) smoothed += D[B * j + i] * AT[j][motion];
            const float before = rows_.columns[place] == own ? T[motions * (B * node + i) + motion] : 0;
            to[motions * i + motion] = before - weight * smoothed;
          }
      }
    });
  }

  [[nodiscard]] int coarse_nodes() const { return aggregates_.count; }
  [[nodiscard]] const SparsePattern& rows() const { return rows_; }
  [[nodiscard]] const Transposed& columns() const { return columns_; }
  /// Return a block of rows().columns: B x 6, by rows.
  [[nodiscard]] const float* block(int place) const { return &values_[std::size_t{B * motions} * place]; }

  /// Compute coarse = P^T fine.
  void restrict_to(std::span<const float> fine, std::span<float> coarse) const {
    // A column's blocks do not follow each other in memory: they are asked for so many blocks ahead.
    constexpr int ahead = 16, numbers_a_line = 16;
    const int last = static_cast<int>(columns_.places.size()) - 1;
    parallel_for(aggregates_.count, [&](std::size_t aggregate) {
      float sums[lanes<motions>] = {};
      for (int at = columns_.starts[aggregate]; at < columns_.starts[aggregate + 1]; ++at) {
        const float* later = block(columns_.places[std::min(at + ahead, last)]);
        for (int k = 0; k < B * motions; k += numbers_a_line) __builtin_prefetch(later + k);
        const float *p = block(columns_.places[at]), *from = &fine[std::size_t{B} * columns_.rows[at]];
        for (int i = 0; i < B; ++i)
#pragma omp simd
          for (int lane = 0; lane < lanes<motions>; ++lane) sums[lane] += p[motions * i + lane] * from[i];
      }
      for (int motion = 0; motion < motions; ++motion) coarse[motions * aggregate + motion] = sums[motion];
    });
  }
  /// Compute fine = P coarse.
  void prolong(std::span<const float> coarse, std::span<float> fine) const {
    parallel_for(rows_.count(), [&](std::size_t node) {
      float sums[B][motions] = {};
      for (int place = rows_.starts[node]; place < rows_.starts[node + 1]; ++place) {
        const float *p = block(place), *from = &coarse[std::size_t{motions} * rows_.columns[place]];
        for (int i = 0; i < B; ++i)
          for (int motion = 0; motion < motions; ++motion) sums[i][motion] += p[motions * i + motion] * from[motion];
      }
      for (int i = 0; i < B; ++i) {
        fine[B * node + i] = 0;
        for (int motion = 0; motion < motions; ++motion) fine[B * node + i] += sums[i][motion];
      }
    });
  }

 private:
  [[nodiscard]] UninitialisedVector<float> tentative(UninitialisedVector<float>& near_kernel) const {
    constexpr int size = B * motions;
    UninitialisedVector<float> T(near_kernel.size() + spare), R(std::size_t{motions * motions} * aggregates_.count);
    parallel_for(aggregates_.count, [&](std::size_t aggregate) {
      const auto members = aggregates_.members.of(static_cast<int>(aggregate));
      Columns Q(B * members.size());
      for (std::size_t m = 0; m < members.size(); ++m)
        for (int i = 0; i < size; ++i)
          Q.at(B * m + i / motions, i % motions) = near_kernel[std::size_t{size} * members[m] + i];
      orthonormalise(Q, &R[motions * motions * aggregate]);
      for (std::size_t m = 0; m < members.size(); ++m)
        for (int i = 0; i < size; ++i)
          T[std::size_t{size} * members[m] + i] = static_cast<float>(Q.at(B * m + i / motions, i % motions));
    });
    near_kernel.swap(R);
    return T;
  }

  Aggregates aggregates_;
  SparsePattern rows_;
  Transposed columns_;
  UninitialisedVector<float> values_;
};

/// Galerkin matrix of the coarser level, P^T A P.
template <int B>
class Galerkin {
 public:
  Galerkin(const SparsePattern& matrix, const Transfer<B>& transfer)
      : product_(collect_pattern(matrix.count(), [&](int node, const auto& take) {
          const auto own = transfer.rows().of(node);
          if (own.empty()) return;
          for (const int n : matrix.of(node))
            for (const int column : transfer.rows().of(n))
              if (column <= own.back()) take(column);
        })) {
    const auto& columns = transfer.columns();
    SparsePattern rows = collect_pattern(transfer.coarse_nodes(), [&](int row, const auto& take) {
      for (int at = columns.starts[row]; at < columns.starts[row + 1]; ++at)
        for (const int column : product_.of(columns.rows[at]))
          if (column <= row) take(column);
    });
    pattern_ = {std::move(rows.starts), std::move(rows.columns)};
  }

  [[nodiscard]] const BlockPattern& pattern() const { return pattern_; }
  /// Return the values of the blocks of the pattern, 6 x 6 each by rows. Unknowns without part in P get the diagonal
  /// 1.
  [[nodiscard]] UninitialisedVector<float> values(const Matrix<B>& matrix, const Transfer<B>& transfer) const {
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

 private:
  static constexpr int wide = lanes<motions>;
  // Rows of A P, B x 6 a block, by rows.
  [[nodiscard]] UninitialisedVector<float> times_transfer(const Matrix<B>& matrix, const Transfer<B>& transfer) const {
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

  SparsePattern product_;  // A P, as required for the lower triangle of P^T A P
  BlockPattern pattern_;
};

}  // namespace plica::multigrid
