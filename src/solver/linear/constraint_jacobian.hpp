// J: gradients of the held constraint functions by free nodes. Terms on a hanging node are passed to the nodes that
// carry it.
//
// Rows of functions of few nodes are sparse; those of functions of thousands are stored as full vectors, outside any
// matrix (border.hpp).
#pragma once

#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "mechanics/model.hpp"

namespace plica {

class ConstraintJacobian {
 public:
  explicit ConstraintJacobian(const Model& model);

  /// Rows: functions of few nodes first, in order of their constraints, then dense ones.
  [[nodiscard]] std::size_t sparse_rows() const { return start_.size() - 1; }
  [[nodiscard]] std::size_t dense_rows() const { return dense_.size(); }
  [[nodiscard]] std::size_t rows() const { return sparse_rows() + dense_rows(); }
  /// Return the index of the multiplier of a row among those of all constraints.
  [[nodiscard]] std::size_t multiplier(std::size_t row) const { return multiplier_[row]; }
  /// Return Constraint::gradient_scale of the function of a row, and its number of parts.
  [[nodiscard]] double gradient_scale(std::size_t row) const { return gradient_scale_[row]; }
  [[nodiscard]] int part_count(std::size_t row) const { return part_count_[row]; }
  /// Row ranges of each constraint: first, last.
  [[nodiscard]] const std::vector<std::pair<std::size_t, std::size_t>>& blocks() const { return blocks_; }

  /// Evaluate the gradients at these positions.
  void update(const Model& model, std::span<const Vec3> positions);

  /// Return J times a vector; rows.
  void rates(std::span<const Vec3> direction, std::span<double> rates) const;
  /// Add factor times weights times J times a vector; sparse rows.
  void add_rates(std::span<const Vec3> direction, std::span<const double> weights, double factor,
                 std::span<double> to) const;
  /// Add factor times J^T times multipliers; nN. Sparse rows only, if there are no more multipliers.
  void add_forces(std::span<const double> multipliers, double factor, std::span<Vec3> forces) const;

  /// Gradient of one function by the position of one node.
  struct Gradient {
    NodeId node;
    Vec3 value;
  };
  /// Return the gradients of a sparse row, by ascending node.
  [[nodiscard]] std::span<const Gradient> of_row(std::size_t row) const {
    return {gradients_.data() + start_[row], gradients_.data() + start_[row + 1]};
  }

  /// Sparse row that depends on a node, and the index of that gradient in the row.
  struct Touch {
    int row, slot;
  };
  /// Return the sparse rows of one free node, ascending.
  [[nodiscard]] std::span<const Touch> around(std::size_t node) const {
    return {touches_.data() + node_start_[node], touches_.data() + node_start_[node + 1]};
  }

  /// Return a dense row, one Vec3 per free node. `row`: from 0.
  [[nodiscard]] std::span<const Vec3> dense_row(std::size_t row) const { return dense_[row]; }

  /// Call body(row, nodes, gradients) for each part of the sparse functions at these positions; if `shared`,
  /// simultaneously for parts without common nodes.
  template <class Body>
  void for_parts(const Model& model, std::span<const Vec3> positions, bool shared, const Body& body) const {
    for (const Source& source : sources_) {
      const Constraint& constraint = model.constraint(source.constraint);
      if (constraint.is_dense()) continue;
      UninitialisedVector<Vec3> gradients(source.slots.size());
      constraint.gradients(positions, gradients);
      constraint.for_parts(
          [&](std::size_t part) {
            const auto nodes = source.parts.nodes[part];
            body(source.first_row + source.parts.function[part], nodes,
                 std::span<const Vec3>(gradients).subspan(source.parts.nodes.start(part), nodes.size()));
          },
          shared);
    }
  }

 private:
  struct HangingSlot {
    std::size_t part, place;  // place: among the nodes of all parts
    int slot;
    double weight;
  };
  /// Destination of the gradients of the parts of a constraint.
  struct Source {
    std::size_t constraint, first_row;
    ConstraintParts parts;
    std::vector<int> slots;  // nodes of all parts: target of a gradient; -1: hanging node
    std::vector<HangingSlot> hanging;
  };
  void add_sparse(const Tissue& tissue, Source& source, std::size_t functions);
  void add_dense(const Tissue& tissue, Source& source, std::size_t functions);
  void find_touches();
  [[nodiscard]] double rate(std::size_t row, std::span<const Vec3> direction) const {
    double sum = 0;
    for (const Gradient& gradient : of_row(row)) sum += gradient.value.dot(direction[gradient.node.index()]);
    return sum;
  }

  std::vector<Source> sources_;
  std::vector<std::size_t> multiplier_;                      // rows
  std::vector<double> gradient_scale_;                       // rows
  std::vector<int> part_count_;                              // rows
  std::vector<std::pair<std::size_t, std::size_t>> blocks_;  // held constraints
  std::vector<std::size_t> start_ = {0};                     // sparse rows + 1
  std::vector<Gradient> gradients_;
  std::vector<std::size_t> node_start_;  // free nodes + 1
  std::vector<Touch> touches_;
  std::vector<Vectors> dense_;  // dense rows; one Vec3 per free node
};

}  // namespace plica
