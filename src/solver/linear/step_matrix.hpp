// The symmetric system of one Newton iteration:
//   [ A  -J^T ] [ dx           ]
//   [ -J   0  ] [ dmultipliers ]
// A: tangent of all laws, constraints and obstacles, 3 x 3 blocks a pair of nodes; J: the sparse rows of the
// constraints' gradients. Nodes are the free ones: what acts on a hanging node acts on those that carry it. Some nodes
// have directions in which they are fixed (held, or in contact): their unknowns are turned into a frame whose first
// axes are those directions, and those rows and columns are taken out.
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

class StepMatrix final : public TangentSink {
 public:
  /// For steps in which the laws' patterns are those of this one.
  explicit StepMatrix(const Model& model, const Step& step = {});

  /// Whether they still are.
  [[nodiscard]] bool serves(const Model& model, const Step& step) const {
    return pattern_revisions(model, step) == revisions_;
  }

  /// The numbers of the whole system, in the order of write_values. Unknowns: three a free node, then one a sparse row
  /// of J.
  [[nodiscard]] Rows pattern() const;

  void set_zero();
  /// The tangent of all laws, constraints and obstacles, and J, at an iterate. std::logic_error, which names the law,
  /// when one adds a block outside the pattern that it states.
  void assemble(const Model& model, const Contacts& contacts, const Step& step, const Iterate& at);
  void add_block(NodeId row, NodeId column, const Mat3& block) override;
  [[nodiscard]] bool takes_apart() const override { return true; }
  void take_gradients(const Model& model, std::span<const Vec3> positions) { jacobian_.update(model, positions); }
  [[nodiscard]] const ConstraintJacobian& jacobian() const { return jacobian_; }

  /// Adds sum_r w_r J_r^T J_r of the sparse rows, spread over their functions' parts so that it joins no more nodes
  /// than they do: the elements of one cell resist their own changes of volume.
  void add_constraint_stiffness(const Model& model, std::span<const Vec3> positions, std::span<const double> weights);

  /// The mean of the diagonal of A, nN/um.
  [[nodiscard]] double mean_diagonal() const;

  /// The block of A of two nodes; 0 where there is none.
  [[nodiscard]] Mat3 block(std::size_t row, std::size_t column) const;

  /// A times a vector that is zero but at `node`, in global axes, all rows.
  void multiply(std::size_t node, const Vec3& direction, std::span<Vec3> product) const;
  /// Values in the pattern's order, turned into the frames, fixed unknowns replaced by the identity.
  void write_values(std::span<const NodeFrame> frames, std::vector<double>& values) const;

  /// Which blocks there are.
  [[nodiscard]] const BlockPattern& layout() const { return layout_; }
  /// The blocks of A with fixed directions projected out, and in their place a diagonal of the block's own size; nine
  /// numbers a block, by rows.
  void write_projected_blocks(std::span<const NodeFrame> frames, UninitialisedVector<float>& values) const;

 private:
  void add_lower(NodeId row, NodeId column, const Mat3& block);  // column <= row, both free

  const Tissue& tissue_;
  std::vector<int> revisions_;
  BlockPattern layout_;  // lower triangle
  std::vector<Mat3> blocks_;
  ConstraintJacobian jacobian_;
  std::atomic<bool> is_outside_ = false;  // a block was given that is not in the pattern
};

}  // namespace plica
