// The symmetric system of one Newton iteration:
//   [ A  -J^T ] [ dx      ]
//   [ -J   0  ] [ dlambda ]
// A: tangent of all laws, 3 x 3 blocks a pair of nodes; J: gradients of the cells' volumes. Nodes are the free ones:
// what acts on a hanging node acts on those that carry it. Some nodes have directions
// in which they are fixed (held, or in contact): their unknowns are turned into a frame whose first axes are those
// directions, and those rows and columns are taken out.
#pragma once

#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "solver/algebra/block_cholesky.hpp"
#include "solver/algebra/linear_solver.hpp"
#include "solver/linear/newton.hpp"
#include "solver/linear/volume_jacobian.hpp"

namespace plica {

class StepMatrix final : public TangentSink {
 public:
  explicit StepMatrix(const Model& model);

  /// The numbers of the whole system, in the order of write_values. Unknowns: three a free node, then one a cell (when
  /// volumes are held).
  [[nodiscard]] SymmetricPattern pattern() const;

  void set_zero();
  /// The tangent of all laws and constraints, and the volumes' gradients, at an iterate.
  void assemble(const Model& model, const Step& step, const Iterate& at);
  void add_block(NodeId row, NodeId column, const Mat3& block) override;
  /// What acts on a hanging node acts on others.
  [[nodiscard]] bool takes_apart() const override { return tissue_.free_node_count() == tissue_.node_count(); }
  void set_volume_gradients(const CellVolumes& volumes, std::span<const Vec3> positions) {
    jacobian_.update(volumes, positions);
  }
  [[nodiscard]] const VolumeJacobian& jacobian() const { return jacobian_; }

  /// Adds sum_c w_c dV_c dV_c^T, spread over the cells' elements so that it joins no more nodes than they do: elements
  /// of one cell resist their own changes of volume.
  void add_volume_stiffness(const Model& model, std::span<const Vec3> positions, std::span<const double> weights);

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
  [[nodiscard]] Mat3& lower_block(NodeId row, NodeId column);  // column <= row, both free

  const Tissue& tissue_;
  BlockPattern layout_;  // lower triangle
  std::vector<Mat3> blocks_;
  VolumeJacobian jacobian_;
};

}  // namespace plica
