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

#include "mechanics/model.hpp"
#include "solver/linear_solver.hpp"

namespace plica {

/// The frame of a node's unknowns. The first `fixed` columns of `axes` are fixed directions.
struct NodeFrame {
  Mat3 axes = Mat3::Identity();
  int fixed = 0;
  bool operator==(const NodeFrame&) const = default;
};

class StepMatrix final : public TangentSink {
 public:
  explicit StepMatrix(const Model& model);

  /// Unknowns: three a free node, then one a cell (when volumes are held).
  [[nodiscard]] const SymmetricPattern& pattern() const { return pattern_; }

  void set_zero();
  void add_block(NodeId row, NodeId column, const Mat3& block) override;
  void set_volume_gradients(const CellVolumes& volumes, std::span<const Vec3> positions);

  /// A times a vector, in global axes, all rows.
  void multiply(std::span<const Vec3> direction, std::span<Vec3> product) const;
  /// J times a vector; cells.
  [[nodiscard]] std::vector<double> volume_rates(std::span<const Vec3> direction) const;
  /// Adds J^T times pressures.
  void add_pressure_forces(std::span<const double> pressures, std::span<Vec3> forces) const;

  /// Values in the pattern's order, turned into the frames, fixed unknowns replaced by the identity.
  void write_values(std::span<const NodeFrame> frames, std::vector<double>& values) const;

 private:
  struct Gradient {  // of one cell's volume to one node's position
    NodeId node;
    Vec3 value;
  };
  void add_free_block(NodeId row, NodeId column, const Mat3& block);

  const Tissue& tissue_;
  // Lower triangle of blocks, row by row: columns_[row_start_[r] .. row_start_[r + 1]) are sorted, the last is r.
  std::vector<int> row_start_, columns_;
  std::vector<Mat3> blocks_;
  std::vector<int> gradient_start_;  // cells + 1
  std::vector<Gradient> gradients_;
  std::vector<std::array<int, 8>> element_slots_;  // elements: where their nodes' gradients are added; -1: node hangs
  struct HangingSlot {
    std::size_t element;
    int corner, slot;
    double weight;
  };
  std::vector<HangingSlot> hanging_slots_;  // the same for hanging nodes, one for each node that carries them
  SymmetricPattern pattern_;
};

}  // namespace plica
