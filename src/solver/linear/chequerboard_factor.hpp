// Preconditioner for chequerboard pressures, which hardly move anything. In a sheet with one element per cell,
// alternating pressures of neighbours cancel: no forces on a regular grid, and small ones where the amplitude varies
// slowly, so no multiple of W approximates their compliance. L = J D^-1 J^T does, with D the diagonal of A: forces that
// alternate from node to node meet the stiffness of each node. Derivation: docs/theory/step.md, Linear systems.
#pragma once

#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/constraint_jacobian.hpp"
#include "solver/linear/step_matrix.hpp"

namespace plica {

/// Factor of L = J D^-1 J^T for the sparse rows, each a cell volume or another function of few nodes. Rows that share a
/// node are neighbours.
class ChequerboardFactor {
 public:
  /// Rows and the nodes that join them; analysed once per topology.
  ChequerboardFactor(const ConstraintJacobian& jacobian, std::size_t free_nodes);

  /// Compute the factor with the diagonal of `matrix` (of A alone), without directions fixed by frames. False if a
  /// node has no stiffness.
  [[nodiscard]] bool factorise(const ConstraintJacobian& jacobian, const StepMatrix& matrix,
                               std::span<const NodeFrame> frames);

  /// Solve L m = rates for the multipliers m, in place; sparse rows.
  void solve(std::span<double> rates) const;

  /// Compute displacements D^-1 f of isolated nodes, in place; the caller handles fixed directions.
  void displace(std::span<Vec3> forces) const;

 private:
  // Blocks of the factor: three rows of J, neighbours if possible.
  static constexpr int rows_a_block = 3;
  struct Place {
    int block = 0, within = 0;
  };
  void gather_blocks(const ConstraintJacobian& jacobian);
  void write_rows(const ConstraintJacobian& jacobian, std::span<const NodeFrame> frames, int block,
                  std::span<float> values) const;

  std::vector<Place> places_;               // rows
  std::vector<std::array<int, 3>> blocks_;  // rows of each block; -1: none
  BlockPattern pattern_;
  std::optional<BlockCholesky> factor_;
  std::vector<double> compliances_;  // D^-1; nodes, um/nN
  mutable std::vector<float> single_;
};

}  // namespace plica
