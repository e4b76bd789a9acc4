// J: how the functions of the constraints that a step holds change with the free nodes. What acts on a hanging node
// acts on those that carry it.
//
// The rows of functions of few nodes are sparse; those of functions of thousands are kept as whole vectors, and never
// meet a matrix (dense_border.hpp).
#pragma once

#include <span>
#include <vector>

#include "core/uninitialised.hpp"
#include "mechanics/model.hpp"

namespace plica {

class ConstraintJacobian {
 public:
  explicit ConstraintJacobian(const Model& model);

  /// Functions of few nodes come first, in the order of their constraints; then the dense ones.
  [[nodiscard]] std::size_t sparse_rows() const { return start_.size() - 1; }
  [[nodiscard]] std::size_t dense_rows() const { return dense_.size(); }
  [[nodiscard]] std::size_t rows() const { return sparse_rows() + dense_rows(); }
  /// The place of a row's multiplier among those of all constraints.
  [[nodiscard]] std::size_t multiplier(std::size_t row) const { return multiplier_[row]; }
  /// Constraint::gradient_scale of a row's function, and of how many parts it is the sum.
  [[nodiscard]] double gradient_scale(std::size_t row) const { return gradient_scale_[row]; }
  [[nodiscard]] int part_count(std::size_t row) const { return part_count_[row]; }
  /// The rows of one constraint each: first, last.
  [[nodiscard]] const std::vector<std::pair<std::size_t, std::size_t>>& blocks() const { return blocks_; }

  /// Takes the gradients at these positions.
  void update(const Model& model, std::span<const Vec3> positions);

  /// J times a vector; rows.
  void rates(std::span<const Vec3> direction, std::span<double> rates) const;
  /// Adds factor times weights times J times a vector; sparse rows.
  void add_rates(std::span<const Vec3> direction, std::span<const double> weights, double factor,
                 std::span<double> to) const;
  /// Adds factor times J^T times multipliers; nN. Of the sparse rows only where there are no more multipliers.
  void add_forces(std::span<const double> multipliers, double factor, std::span<Vec3> forces) const;

  /// Of one function to one node's position.
  struct Gradient {
    NodeId node;
    Vec3 value;
  };
  /// Those of a sparse row, by ascending node.
  [[nodiscard]] std::span<const Gradient> of_row(std::size_t row) const {
    return {gradients_.data() + start_[row], gradients_.data() + start_[row + 1]};
  }

  /// A sparse row that a node changes, and which of that row's gradients is the node's.
  struct Touch {
    int row, slot;
  };
  /// The sparse rows around one free node, in ascending order.
  [[nodiscard]] std::span<const Touch> around(std::size_t node) const {
    return {touches_.data() + node_start_[node], touches_.data() + node_start_[node + 1]};
  }

  /// A dense row; a Vec3 a free node. `row`: from 0.
  [[nodiscard]] std::span<const Vec3> dense_row(std::size_t row) const { return dense_[row]; }

  /// Calls body(row, nodes, gradients) for each part of the sparse rows' functions at these positions; with `shared`,
  /// at once for parts that have no node in common.
  template <class Body>
  void for_parts(const Model& model, std::span<const Vec3> positions, bool shared, const Body& body) const {
    for (const Source& source : sources_) {
      const Constraint& constraint = *model.constraints[source.constraint];
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
  /// Where the gradients of a constraint's parts go.
  struct Source {
    std::size_t constraint, first_row;
    ConstraintParts parts;
    std::vector<int> slots;  // nodes of all parts: where a gradient is added; -1: the node hangs
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
  std::vector<std::pair<std::size_t, std::size_t>> blocks_;  // constraints that are held
  std::vector<std::size_t> start_ = {0};                     // sparse rows + 1
  std::vector<Gradient> gradients_;
  std::vector<std::size_t> node_start_;  // free nodes + 1
  std::vector<Touch> touches_;
  std::vector<Vectors> dense_;  // dense rows; a Vec3 a free node
};

}  // namespace plica
