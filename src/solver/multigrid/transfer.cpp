#include "solver/multigrid/transfer.hpp"

#include <cmath>

#include "core/parallel.hpp"

namespace plica::multigrid {
namespace {

constexpr double damping = 4.0 / 3;  // w times the largest eigenvalue of D^-1 A

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
void orthonormalise(Columns& Q, float* R) {
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

}  // namespace

template <int B>
Transfer<B>::Transfer(const Rows& matrix)
    : aggregates_(make_aggregates(matrix)),
      rows_(collect_rows(matrix.count(),
                         [&](int node, const auto& take) {
                           for (const int n : matrix.of(node))
                             if (aggregates_.of_node[n] != -1) take(aggregates_.of_node[n]);
                         })),
      columns_(transpose(rows_, aggregates_.count)),
      values_(std::size_t{B * motions} * rows_.columns.size() + spare) {}

template <int B>
UninitialisedVector<float> Transfer<B>::tentative(UninitialisedVector<float>& near_kernel) const {
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

template <int B>
void Transfer<B>::update(const Matrix<B>& matrix, double largest_eigenvalue, UninitialisedVector<float>& near_kernel) {
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

template <int B>
void Transfer<B>::restrict_to(std::span<const float> fine, std::span<float> coarse) const {
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

template <int B>
void Transfer<B>::prolong(std::span<const float> coarse, std::span<float> fine) const {
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

template class Transfer<3>;
template class Transfer<6>;

}  // namespace plica::multigrid
