// Preconditioner for chequerboard pressures, which hardly move anything. In a sheet with one element per cell,
// alternating pressures of neighbours cancel: no forces on a regular grid, and small ones where the amplitude varies
// slowly, so no multiple of W approximates their compliance. L = J D^-1 J^T does, with D the diagonal of A: forces that
// alternate from node to node meet the stiffness of each node. Derivation: docs/theory/step.md, Linear systems.
#pragma once

#include <algorithm>
#include <optional>

#include "core/parallel.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/constraint_jacobian.hpp"
#include "solver/linear/system_matrix.hpp"

namespace plica {

/// Factor of L = J D^-1 J^T for the sparse rows, each a cell volume or another function of few nodes. Rows that share a
/// node are neighbours.
class ChequerboardFactor {
 public:
  /// Rows and the nodes that join them; analysed once per topology.
  ChequerboardFactor(const ConstraintJacobian& jacobian, std::size_t free_nodes)
      : places_(jacobian.sparse_rows(), {-1, 0}), compliances_(free_nodes, 0.0) {
    gather_blocks(jacobian);
    pattern_ = {collect_pattern(static_cast<int>(blocks_.size()), [&](int block, const auto& take) {
      for (const int row : blocks_[block]) {
        if (row < 0) continue;
        for (const auto& [node, value] : jacobian.of_row(row))
          for (const auto& touch : jacobian.around(node.index()))
            if (const int other = places_[touch.row].block; other <= block) take(other);
      }
    })};
    factor_.emplace(pattern_);
    single_.resize(rows_a_block * blocks_.size());
  }

  /// Compute the factor with the diagonal of `matrix` (of A alone), without directions fixed by frames. False if a
  /// node has no stiffness.
  [[nodiscard]] bool factorise(const ConstraintJacobian& jacobian, const SystemMatrix& matrix,
                               std::span<const NodeFrame> frames) {
    parallel_for(compliances_.size(), [&](std::size_t n) { compliances_[n] = 3 / matrix.block(n, n).trace(); });
    if (!std::ranges::all_of(compliances_, [](double c) { return c > 0; })) return false;
    std::vector<float> values(9 * pattern_.columns.size(), 0.0F);
    parallel_for(blocks_.size(),
                 [&](std::size_t block) { write_rows(jacobian, frames, static_cast<int>(block), values); });
    return factor_->factorise(values);
  }

  /// Solve L m = rates for the multipliers m, in place; sparse rows.
  void solve(std::span<double> rates) const {
    std::ranges::fill(single_, 0.0F);
    const auto at = [&](std::size_t row) -> float& {
      return single_[rows_a_block * static_cast<std::size_t>(places_[row].block) + places_[row].within];
    };
    parallel_for(rates.size(), [&](std::size_t row) { at(row) = static_cast<float>(rates[row]); });
    factor_->solve(single_);
    parallel_for(rates.size(), [&](std::size_t row) { rates[row] = at(row); });
  }

  /// Compute displacements D^-1 f of isolated nodes, in place; the caller handles fixed directions.
  void displace(std::span<Vec3> forces) const {
    parallel_for(compliances_.size(), [&](std::size_t n) { forces[n] *= compliances_[n]; });
  }

 private:
  // Blocks of the factor: three rows of J, neighbours if possible.
  static constexpr int rows_a_block = 3;
  struct Place {
    int block = 0, within = 0;
  };
  // Each row that is left takes neighbours that are left, those with most nodes in common first.
  void gather_blocks(const ConstraintJacobian& jacobian) {
    for (int row = 0; row < static_cast<int>(places_.size()); ++row) {
      if (places_[row].block >= 0) continue;
      const int block = static_cast<int>(blocks_.size());
      std::array<int, 3> members = {row, -1, -1};
      places_[row] = {block, 0};
      for (int within = 1; within < rows_a_block; ++within) {
        std::vector<int> around;
        for (const auto& [node, value] : jacobian.of_row(members[within - 1]))
          for (const auto& touch : jacobian.around(node.index()))
            if (places_[touch.row].block < 0) around.push_back(touch.row);
        if (around.empty()) break;
        std::ranges::sort(around);
        int best = around.front();
        for (std::size_t i = 0, most = 0; i < around.size();) {
          const std::size_t end = std::ranges::upper_bound(around, around[i]) - around.begin();
          if (end - i > most) {
            most = end - i;
            best = around[i];
          }
          i = end;
        }
        members[within] = best;
        places_[best] = {block, within};
      }
      blocks_.push_back(members);
    }
  }
  void write_rows(const ConstraintJacobian& jacobian, std::span<const NodeFrame> frames, int block,
                  std::span<float> values) const {
    for (const int row : blocks_[block]) {
      if (row < 0) continue;
      for (const auto& [node, value] : jacobian.of_row(row)) {
        const Vec3 moved = compliances_[node.index()] * frames[node.index()].free_part(value);
        for (const auto& [other, slot] : jacobian.around(node.index())) {
          if (places_[other].block > block) continue;
          const std::size_t at = 9 * static_cast<std::size_t>(pattern_.find(block, places_[other].block)) +
                                 3 * places_[row].within + places_[other].within;
          values[at] += static_cast<float>(moved.dot(jacobian.of_row(other)[slot].value));
        }
      }
    }
    // What is left of modes that resist nothing, for single precision; and rows that are not there, or of nodes that
    // are all held.
    constexpr float least = 1e-5F;
    float* diagonal = &values[9 * static_cast<std::size_t>(pattern_.starts[block + 1] - 1)];
    for (int within = 0; within < rows_a_block; ++within) {
      float& value = diagonal[4 * within];
      value = value > 0 ? (1 + least) * value : 1;
    }
  }

  std::vector<Place> places_;               // rows
  std::vector<std::array<int, 3>> blocks_;  // rows of each block; -1: none
  BlockPattern pattern_;
  std::optional<BlockCholesky> factor_;
  std::vector<double> compliances_;  // D^-1; nodes, um/nN
  mutable std::vector<float> single_;
};

}  // namespace plica
