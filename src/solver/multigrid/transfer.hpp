// Between a level of the multigrid and the next coarser one, whose nodes are aggregates with six unknowns each.
#pragma once

#include "solver/multigrid/aggregates.hpp"
#include "solver/multigrid/matrix.hpp"

namespace plica::multigrid {

/// Unknowns of an aggregate: as many as there are rigid motions.
inline constexpr int motions = 6;

/// Smoothed aggregation. T holds, aggregate by aggregate, an orthonormal basis of the rigid motions of its nodes;
/// P = (I - w D^-1 A) T is smoother and reaches the neighbouring aggregates. A rigid motion of all nodes is T R, with R
/// the motions of the coarser level's nodes.
template <int B>
class Transfer {
 public:
  explicit Transfer(const Rows& matrix);

  /// Finds P anew. `near_kernel`: B x 6 numbers a node, by rows; becomes that of the coarser level, 6 x 6 a node. Where
  /// an aggregate has fewer than six motions of its own, the unknowns that are over have no part in P.
  void update(const Matrix<B>& matrix, double largest_eigenvalue, UninitialisedVector<float>& near_kernel);

  [[nodiscard]] int coarse_nodes() const { return aggregates_.count; }
  [[nodiscard]] const Rows& rows() const { return rows_; }
  [[nodiscard]] const Transposed& columns() const { return columns_; }
  /// A block of rows().columns: B x 6, by rows.
  [[nodiscard]] const float* block(int place) const { return &values_[std::size_t{B * motions} * place]; }

  /// coarse = P^T fine.
  void restrict_to(std::span<const float> fine, std::span<float> coarse) const;
  /// fine = P coarse.
  void prolong(std::span<const float> coarse, std::span<float> fine) const;

 private:
  [[nodiscard]] UninitialisedVector<float> tentative(UninitialisedVector<float>& near_kernel) const;

  Aggregates aggregates_;
  Rows rows_;
  Transposed columns_;
  UninitialisedVector<float> values_;
};

extern template class Transfer<3>;
extern template class Transfer<6>;

}  // namespace plica::multigrid
