// J: gradients of the held constraint functions by free nodes. Terms on a hanging node are passed to the nodes that
// carry it.
//
// Rows of functions of few nodes are sparse; those of functions of thousands are stored as full vectors, outside any
// matrix (border.hpp).
#pragma once

#include <algorithm>
#include <numeric>
#include <span>
#include <vector>

#include "core/parallel.hpp"
#include "core/uninitialised.hpp"
#include "mechanics/model.hpp"

namespace plica {

class ConstraintJacobian {
 public:
  explicit ConstraintJacobian(const Model& model) : node_start_(model.tissue.free_node_count() + 1, 0) {
    for (const bool dense : {false, true}) {
      for_held_constraints(model, [&](const Constraint& constraint, std::size_t first_multiplier, std::size_t place) {
        if (constraint.is_dense() != dense) return;
        const std::size_t first_row = multiplier_.size(), functions = constraint.count();
        for (std::size_t f = 0; f < functions; ++f) multiplier_.push_back(first_multiplier + f);
        gradient_scale_.resize(multiplier_.size());
        blocks_.emplace_back(first_row, multiplier_.size());
        part_count_.resize(multiplier_.size(), 0);
        Source source{place, first_row, constraint.parts(), {}, {}};
        for (const int function : source.parts.function) ++part_count_[first_row + function];
        if (dense)
          add_dense(model.tissue, source, functions);
        else
          add_sparse(model.tissue, source, functions);
        sources_.push_back(std::move(source));
      });
    }
    find_row_slots();
  }

  /// Rows: functions of few nodes first, in order of their constraints, then dense ones.
  [[nodiscard]] std::size_t sparse_rows() const { return start_.size() - 1; }
  [[nodiscard]] std::size_t dense_rows() const { return dense_.size(); }
  [[nodiscard]] std::size_t rows() const { return sparse_rows() + dense_rows(); }
  /// Return the index of the multiplier of a row among those of all constraints.
  [[nodiscard]] std::size_t multiplier(std::size_t row) const { return multiplier_[row]; }
  /// Return Constraint::gradient_scale of the function of a row, and its number of parts.
  [[nodiscard]] double gradient_scale(std::size_t row) const { return gradient_scale_[row]; }
  [[nodiscard]] int part_count(std::size_t row) const { return part_count_[row]; }
  /// Whether a matrix may join all nodes of a sparse row. The pattern grows with their square: threefold at this limit,
  /// fortyfold in cells of 10 x 10 x 10 elements.
  [[nodiscard]] bool is_joined(std::size_t row) const {
    constexpr std::size_t most_nodes = 48;  // cells of 3 x 3 x 2 elements; heptagons of kites in two layers
    return part_count_[row] == 1 || of_row(row).size() <= most_nodes;
  }
  /// Row ranges of each constraint: first, last.
  [[nodiscard]] const std::vector<std::pair<std::size_t, std::size_t>>& blocks() const { return blocks_; }

  /// Evaluate the gradients at these positions.
  void update(const Model& model, std::span<const Vec3> positions) {
    parallel_for(gradients_.size(), [&](std::size_t slot) { gradients_[slot].value.setZero(); });
    for (Vectors& row : dense_) std::ranges::fill(row, Vec3::Zero());
    for (const Source& source : sources_) {
      const Constraint& constraint = model.constraint(source.constraint);
      // Cells grow, and their functions with them.
      for (std::size_t f = 0; f < constraint.count(); ++f)
        gradient_scale_[source.first_row + f] = constraint.gradient_scale(f);
      UninitialisedVector<Vec3> of_parts(source.slots.size());
      constraint.gradients(positions, of_parts);
      const bool dense = constraint.is_dense();
      const auto at = [&](std::size_t part, int slot) -> Vec3& {
        if (!dense) return gradients_[slot].value;
        return dense_[source.first_row + source.parts.function[part] - sparse_rows()][slot];
      };
      // In a fixed order for every slot: parts that share a node do not come at once.
      constraint.for_parts(
          [&](std::size_t part) {
            const std::size_t first = source.parts.nodes.start(part), last = source.parts.nodes.start(part + 1);
            for (std::size_t place = first; place < last; ++place)
              if (source.slots[place] >= 0) at(part, source.slots[place]) += of_parts[place];
          },
          true);
      for (const auto& [part, place, slot, weight] : source.hanging) at(part, slot) += weight * of_parts[place];
    }
  }

  /// Return J times a vector; rows.
  void rates(std::span<const Vec3> direction, std::span<double> rates) const {
    parallel_for(sparse_rows(), [&](std::size_t row) { rates[row] = rate(row, direction); });
    for (std::size_t row = 0; row < dense_.size(); ++row) {
      double sum = 0;
      for (std::size_t n = 0; n < dense_[row].size(); ++n) sum += dense_[row][n].dot(direction[n]);
      rates[sparse_rows() + row] = sum;
    }
  }
  /// Add factor times weights times J times a vector; sparse rows.
  void add_rates(std::span<const Vec3> direction, std::span<const double> weights, double factor,
                 std::span<double> to) const {
    parallel_for(sparse_rows(), [&](std::size_t row) { to[row] += factor * weights[row] * rate(row, direction); });
  }
  /// Add factor times J^T times multipliers; nN. Sparse rows only, if there are no more multipliers.
  // A node gets the forces of its rows in their order, either way, so that threads change no bit.
  void add_forces(std::span<const double> multipliers, double factor, std::span<Vec3> forces) const {
    const std::size_t nodes = node_start_.size() - 1;
    constexpr std::size_t worth_sharing = 8192;  // nodes; row by row is faster on one thread
    if (nodes < worth_sharing || omp_get_max_threads() == 1) {
      for (std::size_t row = 0; row < sparse_rows(); ++row) {
        const double multiplier = factor * multipliers[row];
        for (const Gradient& gradient : of_row(row)) forces[gradient.node.index()] += multiplier * gradient.value;
      }
    } else {
      parallel_for(nodes, [&](std::size_t node) {
        for (const auto& [row, slot] : around(node)) {
          const double multiplier = factor * multipliers[row];
          forces[node] += multiplier * of_row(row)[slot].value;
        }
      });
    }
    for (std::size_t row = sparse_rows(); row < multipliers.size(); ++row) {
      const double multiplier = factor * multipliers[row];
      const Vectors& gradient = dense_[row - sparse_rows()];
      parallel_for(gradient.size(), [&](std::size_t n) { forces[n] += multiplier * gradient[n]; });
    }
  }

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
  struct RowSlot {
    int row, slot;
  };
  /// Return the sparse rows of one free node, ascending.
  [[nodiscard]] std::span<const RowSlot> around(std::size_t node) const {
    return {row_slots_.data() + node_start_[node], row_slots_.data() + node_start_[node + 1]};
  }

  /// Return a dense row, one Vec3 per free node. `row`: from 0.
  [[nodiscard]] std::span<const Vec3> dense_row(std::size_t row) const { return dense_[row]; }

  /// Call body(row, nodes, gradients) for each part of the sparse functions that are not joined, at these positions; if
  /// `shared`, simultaneously for parts without common nodes.
  template <class Body>
  void for_parts_apart(const Model& model, std::span<const Vec3> positions, bool shared, const Body& body) const {
    for (const Source& source : sources_) {
      const Constraint& constraint = model.constraint(source.constraint);
      const auto is_apart = [&](int function) { return !is_joined(source.first_row + function); };
      if (constraint.is_dense() || std::ranges::none_of(source.parts.function, is_apart)) continue;
      UninitialisedVector<Vec3> gradients(source.slots.size());
      constraint.gradients(positions, gradients);
      constraint.for_parts(
          [&](std::size_t part) {
            if (!is_apart(source.parts.function[part])) return;
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
  void add_sparse(const Tissue& tissue, Source& source, std::size_t functions) {
    const NodeGroups& parts = source.parts.nodes;
    // The parts of each function, one function after the other.
    std::vector<std::size_t> first_part(functions + 1, 0), by_function(parts.size());
    for (const int function : source.parts.function) ++first_part[function + 1];
    std::partial_sum(first_part.begin(), first_part.end(), first_part.begin());
    std::vector<std::size_t> next(first_part.begin(), first_part.end() - 1);
    for (std::size_t part = 0; part < parts.size(); ++part) by_function[next[source.parts.function[part]]++] = part;
    source.slots.resize(parts.start(parts.size()));
    std::vector<NodeId> members;
    for (std::size_t function = 0; function < functions; ++function) {
      const auto own_parts =
          std::span(by_function).subspan(first_part[function], first_part[function + 1] - first_part[function]);
      members.clear();
      for (const std::size_t part : own_parts)
        for (const NodeId node : parts[part])
          tissue.for_free_nodes(node, [&](NodeId n, double) { members.push_back(n); });
      std::sort(members.begin(), members.end());
      members.erase(std::unique(members.begin(), members.end()), members.end());
      const int offset = static_cast<int>(gradients_.size());
      for (const std::size_t part : own_parts)
        for (std::size_t i = 0; i < parts[part].size(); ++i) {
          const NodeId node = parts[part][i];
          const std::size_t place = parts.start(part) + i;
          tissue.for_free_nodes(node, [&](NodeId n, double weight) {
            const auto at = std::lower_bound(members.begin(), members.end(), n);
            const int slot = offset + static_cast<int>(at - members.begin());
            const bool hangs = n != node;
            source.slots[place] = hangs ? -1 : slot;
            if (hangs) source.hanging.push_back({part, place, slot, weight});
          });
        }
      for (const NodeId node : members) gradients_.push_back({node, Vec3::Zero()});
      start_.push_back(gradients_.size());
    }
  }
  void add_dense(const Tissue& tissue, Source& source, std::size_t functions) {
    const NodeGroups& parts = source.parts.nodes;
    source.slots.resize(parts.start(parts.size()));
    for (std::size_t part = 0; part < parts.size(); ++part)
      for (std::size_t i = 0; i < parts[part].size(); ++i) {
        const NodeId node = parts[part][i];
        const std::size_t place = parts.start(part) + i;
        tissue.for_free_nodes(node, [&](NodeId n, double weight) {
          source.slots[place] = n == node ? n.number() : -1;
          if (n != node) source.hanging.push_back({part, place, n.number(), weight});
        });
      }
    dense_.resize(dense_.size() + functions, Vectors(tissue.free_node_count()));
  }
  void find_row_slots() {
    for (const Gradient& gradient : gradients_) ++node_start_[gradient.node.index() + 1];
    for (std::size_t n = 0; n + 1 < node_start_.size(); ++n) node_start_[n + 1] += node_start_[n];
    row_slots_.resize(gradients_.size());
    std::vector<std::size_t> next(node_start_.begin(), node_start_.end() - 1);
    for (int row = 0; row < static_cast<int>(sparse_rows()); ++row) {
      int slot = 0;
      for (const Gradient& gradient : of_row(row)) row_slots_[next[gradient.node.index()]++] = {row, slot++};
    }
  }
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
  std::vector<RowSlot> row_slots_;
  std::vector<Vectors> dense_;  // dense rows; one Vec3 per free node
};

}  // namespace plica
