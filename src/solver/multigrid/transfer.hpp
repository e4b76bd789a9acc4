// Transfer between a multigrid level and the next coarser one, whose nodes are aggregates with six unknowns each.
#pragma once

#include "solver/multigrid/aggregates.hpp"
#include "solver/multigrid/matrix.hpp"

namespace plica::multigrid {

/// Number of unknowns of an aggregate: one per rigid motion.
inline constexpr int motions = 6;

/// Smoothed aggregation. T contains, per aggregate, an orthonormal basis of the rigid motions of its nodes; P = (I - w
/// D^-1 A) T is smoother and reaches the neighbouring aggregates. A rigid motion of all nodes is T R, with R the
/// motions of the coarser nodes.
template <int B>
class Transfer {
 public:
  explicit Transfer(const Rows& matrix);

  /// Recompute P. `near_kernel`: B x 6 numbers per node, by rows; replaced by that of the coarser level, 6 x 6 per
  /// node. If an aggregate has fewer than six independent motions, the surplus unknowns have no part in P.
  void update(const Matrix<B>& matrix, double largest_eigenvalue, UninitialisedVector<float>& near_kernel);

  [[nodiscard]] int coarse_nodes() const { return aggregates_.count; }
  [[nodiscard]] const Rows& rows() const { return rows_; }
  [[nodiscard]] const Transposed& columns() const { return columns_; }
  /// Return a block of rows().columns: B x 6, by rows.
  [[nodiscard]] const float* block(int place) const { return &values_[std::size_t{B * motions} * place]; }

  /// Compute coarse = P^T fine.
  void restrict_to(std::span<const float> fine, std::span<float> coarse) const;
  /// Compute fine = P coarse.
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
