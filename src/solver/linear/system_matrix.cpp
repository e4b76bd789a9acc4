#include "solver/linear/system_matrix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "core/parallel.hpp"

namespace plica {

namespace {

// The free nodes of every group that a law, a constraint or, if given, a row of J joins; what joins the same groups
// once.
SparsePattern joined_nodes(const Model& model, const Step& step, const ConstraintJacobian* jacobian) {
  std::vector<NodeGroups> lists;
  const auto take = [&](NodeGroups groups) {
    if (std::ranges::find(lists, groups) == lists.end()) lists.push_back(std::move(groups));
  };
  for_laws(model, step, [&](const Law& law, const Step& law_step) { take(law.node_groups(law_step.internal)); });
  for_held_constraints(model,
                       [&](const Constraint& constraint, std::size_t, std::size_t) { take(constraint.parts().nodes); });
  SparsePattern joined;
  for (const NodeGroups& groups : lists)
    for (std::size_t k = 0; k < groups.size(); ++k) {
      for (const NodeId node : groups[k])
        model.tissue.for_free_nodes(node, [&](NodeId n, double) { joined.columns.push_back(n.number()); });
      joined.starts.push_back(static_cast<int>(joined.columns.size()));
    }
  for (std::size_t row = 0; jacobian != nullptr && row < jacobian->sparse_rows(); ++row) {
    const bool is_in_lists = jacobian->part_count(row) == 1;
    if (is_in_lists || !jacobian->is_joined(row)) continue;
    for (const auto& gradient : jacobian->of_row(row)) joined.columns.push_back(gradient.node.number());
    joined.starts.push_back(static_cast<int>(joined.columns.size()));
  }
  return joined;
}

// The blocks that can be non-zero: of pairs within a group, and of every node with itself.
BlockPattern pattern_of(const Model& model, const Step& step, const ConstraintJacobian* jacobian) {
  const int nodes = static_cast<int>(model.tissue.free_node_count());
  const SparsePattern groups = joined_nodes(model, step, jacobian);
  const Transposed of_node = transpose(groups, nodes);
  SparsePattern lower = collect_pattern(nodes, [&](int node, const auto& take) {
    take(node);
    for (int at = of_node.starts[node]; at < of_node.starts[node + 1]; ++at)
      for (const int other : groups.of(of_node.rows[at]))
        if (other < node) take(other);
  });
  return {std::move(lower)};
}

}  // namespace

std::vector<int> groups_revisions(const Model& model, const Step& step) {
  std::vector<int> revisions;
  for_laws(model, step,
           [&](const Law& law, const Step& law_step) { revisions.push_back(law.groups_revision(law_step.internal)); });
  return revisions;
}

SystemMatrix::SystemMatrix(const Model& model, const Step& step, bool is_regularised)
    : tissue_(model.tissue),
      revisions_(groups_revisions(model, step)),
      jacobian_(model),
      layout_(pattern_of(model, step, is_regularised ? &jacobian_ : nullptr)),
      blocks_(layout_.columns.size()) {}

SparsePattern SystemMatrix::pattern() const {
  SparsePattern pattern;
  const int nodes = layout_.nodes();
  const auto end_row = [&] { pattern.starts.push_back(static_cast<int>(pattern.columns.size())); };
  for (int node = 0; node < nodes; ++node)
    for (int i = 0; i < 3; ++i) {
      for (const int column : layout_.of(node))
        for (int j = 0; j < (column == node ? i + 1 : 3); ++j) pattern.columns.push_back(3 * column + j);
      end_row();
    }
  for (int row = 0; row < static_cast<int>(jacobian_.sparse_rows()); ++row) {
    for (const auto& [node, value] : jacobian_.of_row(row))
      for (int j = 0; j < 3; ++j) pattern.columns.push_back(3 * node.number() + j);
    pattern.columns.push_back(3 * nodes + row);
    end_row();
  }
  return pattern;
}

void SystemMatrix::set_zero() {
  // More than a core's caches hold. With 756 cells it would be the only shared loop of a step, and cost a run on two
  // cores a seventh of its solver's time.
  constexpr std::size_t worth_sharing = 100'000;
  parallel_for(
      blocks_.size(), [&](std::size_t k) { blocks_[k].setZero(); }, worth_sharing);
}

void SystemMatrix::add_block(NodeId row, NodeId column, const Mat3& block) {
  const std::size_t free = tissue_.free_node_count();
  if (row.index() < free && column.index() < free) {
    if (column <= row)
      add_lower(row, column, block);
    else
      add_lower(column, row, block.transpose());
    return;
  }
  tissue_.for_free_nodes(row, [&](NodeId r, double weight_r) {
    tissue_.for_free_nodes(column, [&](NodeId c, double weight_c) {
      // Both orders of a pair; nodes that carry both of them are in it twice.
      if (c <= r) add_lower(r, c, weight_r * weight_c * block);
      if (r <= c && row != column) add_lower(c, r, weight_r * weight_c * block.transpose());
    });
  });
}

void SystemMatrix::add_lower(NodeId row, NodeId column, const Mat3& block) {
  const int at = layout_.place(row.number(), column.number());
  if (at < 0)
    is_outside_ = true;  // told by `assemble`: not here, where several threads may be
  else
    blocks_[at] += block;
}

void SystemMatrix::assemble(const Model& model, const ObstacleContacts& contacts, const Step& step, const Iterate& at) {
  set_zero();
  const auto refuse_outside = [&](std::string_view name) {
    if (is_outside_.exchange(false))
      throw std::logic_error(fmt::format(
          "\"{}\" adds to the tangent a block of nodes that its pattern does not join (node_groups, parts)", name));
  };
  for_laws(model, step, [&](const Law& law, const Step& law_step) {
    law.add_tangent(law_step, *this);
    refuse_outside(law.name());
  });
  for_held_constraints(model, [&](const Constraint& constraint, std::size_t first, std::size_t) {
    if (step.semidefinite_tangent) return;
    constraint.add_tangent(at.positions, std::span(at.multipliers).subspan(first, constraint.count()), *this);
    refuse_outside(constraint.name());
  });
  jacobian_.update(at_end(model, step), at.positions);
  for (std::size_t k = 0; k < at.on_obstacle.size(); ++k)
    if (at.on_obstacle[k])
      add_block(contacts.node(k), contacts.node(k), -at.obstacle_forces[k] * contacts.gap(k, at.positions).hessian);
}

void SystemMatrix::add_constraint_stiffness(const Model& model, std::span<const Vec3> positions,
                                            std::span<const double> weights) {
  // Every node has its own row of blocks, so threads change no bit.
  parallel_for(tissue_.free_node_count(), [&](std::size_t node) {
    for (const auto& [row, slot] : jacobian_.around(node)) {
      if (!jacobian_.is_joined(row)) continue;
      const auto gradients = jacobian_.of_row(row);
      const Vec3 weighted = weights[row] * gradients[slot].value;
      for (const auto& other : gradients.first(slot + 1))
        add_lower(gradients[slot].node, other.node, weighted * other.value.transpose());
    }
  });
  jacobian_.for_parts_apart(model, positions, accepts_concurrent_blocks(),
                            [&](std::size_t row, std::span<const NodeId> nodes, std::span<const Vec3> gradients) {
                              // sum_p n (dc_p)^2 >= (sum_p dc_p)^2, of n parts.
                              const double weight = weights[row] * jacobian_.part_count(row);
                              for (std::size_t i = 0; i < nodes.size(); ++i)
                                for (std::size_t j = 0; j <= i; ++j)
                                  add_block(nodes[i], nodes[j], weight * gradients[i] * gradients[j].transpose());
                            });
}

double SystemMatrix::mean_diagonal() const {
  double sum = 0;
  for (int n = 0; n < layout_.nodes(); ++n) sum += blocks_[layout_.starts[n + 1] - 1].trace();
  return sum / (3 * layout_.nodes());
}

Mat3 SystemMatrix::block(std::size_t row, std::size_t column) const {
  if (column > row) return block(column, row).transpose();
  const int at = layout_.place(static_cast<int>(row), static_cast<int>(column));
  return at < 0 ? Mat3(Mat3::Zero()) : blocks_[at];
}

void SystemMatrix::multiply(std::size_t node, const Vec3& direction, std::span<Vec3> product) const {
  for (std::size_t row = 0; row < product.size(); ++row) product[row] = block(row, node) * direction;
}

namespace {

// The diagonal of a fixed unknown: any number will do; one of the block's own size suits the factor's scaling.
double pivot(double diagonal) { return diagonal != 0 ? diagonal : 1; }

}  // namespace

void SystemMatrix::write_values(std::span<const NodeFrame> frames, std::vector<double>& values) const {
  values.clear();
  values.reserve(9 * blocks_.size());
  std::vector<Mat3> turned;  // the blocks of a node's rows
  for (int row = 0; row < layout_.nodes(); ++row) {
    const NodeFrame& a = frames[row];
    turned.clear();
    for (int k = layout_.starts[row]; k < layout_.starts[row + 1]; ++k) {
      const NodeFrame& b = frames[layout_.columns[k]];
      Mat3 block = blocks_[k];
      if (a.fixed > 0) block = a.axes.transpose() * block;
      if (b.fixed > 0) block = block * b.axes;
      turned.push_back(block);
    }
    for (int i = 0; i < 3; ++i)
      for (std::size_t k = 0; k < turned.size(); ++k) {
        const int column = layout_.columns[layout_.starts[row] + k];
        for (int j = 0; j < (column == row ? i + 1 : 3); ++j) {
          const bool fixed = i < a.fixed || j < frames[column].fixed;
          values.push_back(!fixed ? turned[k](i, j) : column == row && i == j ? pivot(turned[k](i, i)) : 0.0);
        }
      }
  }
  for (std::size_t row = 0; row < jacobian_.sparse_rows(); ++row) {
    bool can_change = false;
    for (const auto& [node, gradient] : jacobian_.of_row(row)) {
      const NodeFrame& frame = frames[node.index()];
      const Vec3 local = frame.axes.transpose() * gradient;
      for (int j = 0; j < 3; ++j) {
        values.push_back(j < frame.fixed ? 0.0 : -local[j]);
        can_change = can_change || (j >= frame.fixed && local[j] != 0);
      }
    }
    // A function none of whose nodes can move needs no multiplier; a pivot keeps its row from being empty.
    values.push_back(can_change ? 0.0 : -1.0);
  }
}

void SystemMatrix::write_projected_blocks(std::span<const NodeFrame> frames, UninitialisedVector<float>& values) const {
  values.resize(9 * blocks_.size());
  const auto fixed_part = [](const NodeFrame& frame) {
    const auto axes = frame.axes.leftCols(frame.fixed);
    return Mat3(axes * axes.transpose());
  };
  parallel_for(frames.size(), [&](std::size_t row) {
    for (int k = layout_.starts[row]; k < layout_.starts[row + 1]; ++k) {
      const std::size_t column = layout_.columns[k];
      Mat3 block = blocks_[k];
      const double size = block.trace() / 3;
      if (frames[row].fixed > 0) block -= fixed_part(frames[row]) * block;
      if (frames[column].fixed > 0) block -= block * fixed_part(frames[column]);
      if (column == row && frames[row].fixed > 0) block += pivot(size) * fixed_part(frames[row]);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) values[9 * k + 3 * i + j] = static_cast<float>(block(i, j));
    }
  });
}

}  // namespace plica
