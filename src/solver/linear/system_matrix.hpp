// The symmetric system of one Newton iteration:
//   [ A  -J^T ] [ dx           ]
//   [ -J   0  ] [ dmultipliers ]
// A: tangent of all laws, constraints and obstacles, one 3 x 3 block per pair of nodes; J: sparse constraint
// gradients. Nodes are the free ones; terms on a hanging node are passed to those that carry it. Unknowns of nodes with
// fixed directions (held, or in contact) are rotated into a frame whose first axes are those directions, and those rows
// and columns are removed.
#pragma once

#include <atomic>
#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/algebra/linear_solver.hpp"
#include "solver/linear/constraint_jacobian.hpp"
#include "solver/linear/iterate.hpp"
#include "solver/linear/node_frame.hpp"

namespace plica {

/// Return the pattern revisions of the laws in a step; a matrix is valid while they are unchanged.
std::vector<int> groups_revisions(const Model& model, const Step& step);

class SystemMatrix final : public TangentSink {
 public:
  /// Make the matrix for steps with the patterns of this one; `is_regularised`: with room for constraint stiffness.
  explicit SystemMatrix(const Model& model, const Step& step = {}, bool is_regularised = true);

  /// Whether the patterns are unchanged.
  [[nodiscard]] bool serves(const Model& model, const Step& step) const {
    return groups_revisions(model, step) == revisions_;
  }

  /// Return the pattern of the full system, in the order of write_values. Unknowns: three per free node, then one per
  /// sparse row of J.
  [[nodiscard]] SparsePattern pattern() const;

  void set_zero();
  /// Assemble the tangent of all laws, constraints and obstacles, and J, at an iterate. std::logic_error, naming the
  /// law, if it adds a block outside its pattern.
  void assemble(const Model& model, const ObstacleContacts& contacts, const Step& step, const Iterate& at);
  void add_block(NodeId row, NodeId column, const Mat3& block) override;
  [[nodiscard]] bool accepts_concurrent_blocks() const override { return true; }
  void take_gradients(const Model& model, std::span<const Vec3> positions) { jacobian_.update(model, positions); }
  [[nodiscard]] const ConstraintJacobian& jacobian() const { return jacobian_; }

  /// Add sum_r w_r J_r^T J_r of the sparse rows, with the gradients of the last `assemble` or `take_gradients`. That of
  /// a function of very many nodes (ConstraintJacobian::is_joined) is distributed over its parts, at these positions,
  /// so that no further nodes are joined: the elements of such a cell each resist their own volume change.
  void add_constraint_stiffness(const Model& model, std::span<const Vec3> positions, std::span<const double> weights);

  /// Return the mean of the diagonal of A, nN/um.
  [[nodiscard]] double mean_diagonal() const;

  /// Return the block of A of two nodes; 0 if absent.
  [[nodiscard]] Mat3 block(std::size_t row, std::size_t column) const;

  /// Return A times a vector that is zero except at `node`, in global axes, all rows.
  void multiply(std::size_t node, const Vec3& direction, std::span<Vec3> product) const;
  /// Write values in the order of the pattern, rotated into the frames, fixed unknowns replaced by the identity.
  void write_values(std::span<const NodeFrame> frames, std::vector<double>& values) const;

  /// Return the block pattern.
  [[nodiscard]] const BlockPattern& layout() const { return layout_; }
  /// Write the blocks of A with fixed directions projected out and replaced by a diagonal of the size of the block;
  /// nine numbers per block, by rows.
  void write_projected_blocks(std::span<const NodeFrame> frames, UninitialisedVector<float>& values) const;

 private:
  void add_lower(NodeId row, NodeId column, const Mat3& block);  // column <= row, both free

  const Tissue& tissue_;
  std::vector<int> revisions_;
  ConstraintJacobian jacobian_;
  BlockPattern layout_;  // lower triangle
  std::vector<Mat3> blocks_;
  std::atomic<bool> is_outside_ = false;  // whether a block outside the pattern was added
};

}  // namespace plica
