#include "solver/linear/constraint_jacobian.hpp"

#include <algorithm>
#include <numeric>

#include "core/parallel.hpp"

namespace plica {

ConstraintJacobian::ConstraintJacobian(const Model& model) : node_start_(model.tissue.free_node_count() + 1, 0) {
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
  find_touches();
}

void ConstraintJacobian::add_sparse(const Tissue& tissue, Source& source, std::size_t functions) {
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

void ConstraintJacobian::add_dense(const Tissue& tissue, Source& source, std::size_t functions) {
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

void ConstraintJacobian::find_touches() {
  for (const Gradient& gradient : gradients_) ++node_start_[gradient.node.index() + 1];
  for (std::size_t n = 0; n + 1 < node_start_.size(); ++n) node_start_[n + 1] += node_start_[n];
  touches_.resize(gradients_.size());
  std::vector<std::size_t> next(node_start_.begin(), node_start_.end() - 1);
  for (int row = 0; row < static_cast<int>(sparse_rows()); ++row) {
    int slot = 0;
    for (const Gradient& gradient : of_row(row)) touches_[next[gradient.node.index()]++] = {row, slot++};
  }
}

void ConstraintJacobian::update(const Model& model, std::span<const Vec3> positions) {
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

void ConstraintJacobian::rates(std::span<const Vec3> direction, std::span<double> rates) const {
  parallel_for(sparse_rows(), [&](std::size_t row) { rates[row] = rate(row, direction); });
  for (std::size_t row = 0; row < dense_.size(); ++row) {
    double sum = 0;
    for (std::size_t n = 0; n < dense_[row].size(); ++n) sum += dense_[row][n].dot(direction[n]);
    rates[sparse_rows() + row] = sum;
  }
}

void ConstraintJacobian::add_rates(std::span<const Vec3> direction, std::span<const double> weights, double factor,
                                   std::span<double> to) const {
  parallel_for(sparse_rows(), [&](std::size_t row) { to[row] += factor * weights[row] * rate(row, direction); });
}

// A node gets the forces of its rows in their order, either way, so that threads change no bit.
void ConstraintJacobian::add_forces(std::span<const double> multipliers, double factor, std::span<Vec3> forces) const {
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

}  // namespace plica
