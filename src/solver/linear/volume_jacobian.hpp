// J: how the cells' volumes change with the free nodes. What acts on a hanging node acts on those that carry it.
#pragma once

#include <span>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

class VolumeJacobian {
 public:
  /// No rows when the model does not hold volumes.
  explicit VolumeJacobian(const Model& model);

  [[nodiscard]] std::size_t cells() const { return start_.size() - 1; }

  /// Takes the gradients at these positions.
  void update(const CellVolumes& volumes, std::span<const Vec3> positions);

  /// J times a vector; cells, um^3.
  void rates(std::span<const Vec3> direction, std::span<double> rates) const;
  /// Adds factor times weights times J times a vector; cells.
  void add_rates(std::span<const Vec3> direction, std::span<const double> weights, double factor,
                 std::span<double> to) const;
  /// Adds factor times J^T times pressures; nN.
  void add_forces(std::span<const double> pressures, double factor, std::span<Vec3> forces) const;

  /// Of one cell's volume to one node's position, um^2.
  struct Gradient {
    NodeId node;
    Vec3 value;
  };
  /// Those of one cell, by ascending node.
  [[nodiscard]] std::span<const Gradient> of_cell(std::size_t cell) const {
    return {gradients_.data() + start_[cell], gradients_.data() + start_[cell + 1]};
  }

  /// A cell whose volume a node changes, and which of that cell's gradients is the node's.
  struct Touch {
    int cell, slot;
  };
  /// The cells around one free node, in ascending order.
  [[nodiscard]] std::span<const Touch> around(std::size_t node) const {
    return {touches_.data() + node_start_[node], touches_.data() + node_start_[node + 1]};
  }

 private:
  [[nodiscard]] double rate(std::size_t cell, std::span<const Vec3> direction) const {
    double sum = 0;
    for (const Gradient& gradient : of_cell(cell)) sum += gradient.value.dot(direction[gradient.node.index()]);
    return sum;
  }

  std::vector<std::size_t> start_;  // cells + 1
  std::vector<Gradient> gradients_;
  std::vector<std::size_t> node_start_;  // free nodes + 1
  std::vector<Touch> touches_;
  std::vector<std::array<int, 8>> element_slots_;  // elements: where their nodes' gradients are added; -1: node hangs
  struct HangingSlot {
    std::size_t element;
    int corner, slot;
    double weight;
  };
  std::vector<HangingSlot> hanging_slots_;  // the same for hanging nodes, one for each node that carries them
};

}  // namespace plica
