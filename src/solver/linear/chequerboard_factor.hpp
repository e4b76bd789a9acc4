// Pressures that hardly move anything. In a sheet whose cells are one element each, neighbours with pressures of
// opposite sign push against each other: the chequerboard makes no forces at all on a regular grid, and nearly none
// where its amplitude changes slowly, so that no multiple of W comes near what resists it. L = J D^-1 J^T does, D being
// the diagonal of A: forces that change from node to node meet the stiffness of each node. Derivation:
// docs/theory/step.md, Linear systems.
#pragma once

#include "solver/algebra/block_cholesky.hpp"
#include "solver/linear/constraint_jacobian.hpp"
#include "solver/linear/step_matrix.hpp"

namespace plica {

/// L = J D^-1 J^T of the sparse rows, each a cell's volume or another function of few nodes, and its factor. Rows that
/// share a node are neighbours.
class ChequerboardFactor {
 public:
  /// Rows and nodes that join them: analysed once a topology.
  ChequerboardFactor(const ConstraintJacobian& jacobian, std::size_t free_nodes);

  /// Makes the factor with the diagonal of `matrix` (of A alone) and without the directions that frames fix. False when
  /// a node has no stiffness.
  [[nodiscard]] bool factorise(const ConstraintJacobian& jacobian, const StepMatrix& matrix,
                               std::span<const NodeFrame> frames);

  /// Multipliers m with L m = rates, in place; sparse rows.
  void solve(std::span<double> rates) const;

  /// Displacements by forces where each node is alone: D^-1 f, in place. Fixed directions are the caller's.
  void displace(std::span<Vec3> forces) const;

 private:
  // The factor's blocks are of three rows of J, neighbours where there are any.
  static constexpr int rows_a_block = 3;
  struct Place {
    int block = 0, within = 0;
  };
  void gather_blocks(const ConstraintJacobian& jacobian);
  void write_rows(const ConstraintJacobian& jacobian, std::span<const NodeFrame> frames, int block,
                  std::span<float> values) const;

  std::vector<Place> places_;               // rows
  std::vector<std::array<int, 3>> blocks_;  // their rows; -1: none
  BlockPattern pattern_;
  std::optional<BlockCholesky> factor_;
  std::vector<double> compliances_;  // of D^-1; nodes, um/nN
  mutable std::vector<float> single_;
};

}  // namespace plica
