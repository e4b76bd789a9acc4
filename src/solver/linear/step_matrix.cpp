#include "solver/linear/step_matrix.hpp"

#include <algorithm>

#include "core/parallel.hpp"
#include "solver/multigrid/rows.hpp"

namespace plica {

namespace {

// The free nodes of every group that a law or the volumes join; laws that join the same groups once.
multigrid::Rows joined_nodes(const Model& model) {
  std::vector<NodeGroups> lists;
  const auto take = [&](NodeGroups groups) {
    if (std::ranges::find(lists, groups) == lists.end()) lists.push_back(std::move(groups));
  };
  for (const auto& law : model.laws) take(law->node_groups({}));
  if (model.volumes_are_held) {
    NodeGroups elements;
    for (const auto& element : model.tissue.elements) elements.add(element);
    take(std::move(elements));
  }
  multigrid::Rows joined;
  for (const NodeGroups& groups : lists)
    for (std::size_t k = 0; k < groups.size(); ++k) {
      for (const NodeId node : groups[k])
        model.tissue.for_free_nodes(node, [&](NodeId n, double) { joined.columns.push_back(n.number()); });
      joined.starts.push_back(static_cast<int>(joined.columns.size()));
    }
  return joined;
}

// The blocks that can be non-zero: of pairs within a group, and of every node with itself.
BlockPattern pattern_of(const Model& model) {
  const int nodes = static_cast<int>(model.tissue.free_node_count());
  const multigrid::Rows groups = joined_nodes(model);
  const multigrid::Transposed of_node = multigrid::transpose(groups, nodes);
  multigrid::Rows lower = multigrid::collect_rows(nodes, [&](int node, const auto& take) {
    take(node);
    for (int at = of_node.starts[node]; at < of_node.starts[node + 1]; ++at)
      for (const int other : groups.of(of_node.rows[at]))
        if (other < node) take(other);
  });
  return {std::move(lower.starts), std::move(lower.columns)};
}

}  // namespace

StepMatrix::StepMatrix(const Model& model)
    : tissue_(model.tissue), layout_(pattern_of(model)), blocks_(layout_.columns.size()), jacobian_(model) {}

SymmetricPattern StepMatrix::pattern() const {
  SymmetricPattern pattern;
  const int nodes = layout_.nodes();
  const int cells = static_cast<int>(jacobian_.cells());
  pattern.size = 3 * nodes + cells;
  const auto entry = [&](int row, int column) {
    pattern.rows.push_back(row);
    pattern.columns.push_back(column);
  };
  for (int row = 0; row < nodes; ++row)
    for (int k = layout_.starts[row]; k < layout_.starts[row + 1]; ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (layout_.columns[k] == row ? i + 1 : 3); ++j)
          entry(3 * row + i, 3 * layout_.columns[k] + j);
  for (int cell = 0; cell < cells; ++cell) {
    for (const auto& [node, value] : jacobian_.of_cell(cell))
      for (int j = 0; j < 3; ++j) entry(3 * nodes + cell, 3 * node.number() + j);
    entry(3 * nodes + cell, 3 * nodes + cell);
  }
  return pattern;
}

void StepMatrix::set_zero() {
  // More than a core's caches hold. With 756 cells it would be the only shared loop of a step, and cost a run on two
  // cores a seventh of its solver's time.
  constexpr std::size_t worth_sharing = 100'000;
  parallel_for(
      blocks_.size(), [&](std::size_t k) { blocks_[k].setZero(); }, worth_sharing);
}

void StepMatrix::add_block(NodeId row, NodeId column, const Mat3& block) {
  const std::size_t free = tissue_.free_node_count();
  if (row.index() < free && column.index() < free) {
    if (column <= row)
      lower_block(row, column) += block;
    else
      lower_block(column, row) += block.transpose();
    return;
  }
  tissue_.for_free_nodes(row, [&](NodeId r, double weight_r) {
    tissue_.for_free_nodes(column, [&](NodeId c, double weight_c) {
      // Both orders of a pair; nodes that carry both of them are in it twice.
      if (c <= r) lower_block(r, c) += weight_r * weight_c * block;
      if (r <= c && row != column) lower_block(c, r) += weight_r * weight_c * block.transpose();
    });
  });
}

Mat3& StepMatrix::lower_block(NodeId row, NodeId column) {
  const auto first = layout_.columns.begin() + layout_.starts[row.index()],
             last = layout_.columns.begin() + layout_.starts[row.index() + 1];
  return blocks_[std::lower_bound(first, last, column.number()) - layout_.columns.begin()];
}

void StepMatrix::assemble(const Model& model, const Step& step, const Iterate& at) {
  set_zero();
  for (const auto& law : model.laws) law->add_tangent(step, *this);
  if (model.volumes_are_held) {
    if (!step.semidefinite_tangent) model.volumes.add_tangent(at.positions, at.pressures, *this);
    jacobian_.update(model.volumes, at.positions);
  }
  for (std::size_t k = 0; k < at.in_contact.size(); ++k)
    if (at.in_contact[k]) {
      const NodeId node = model.vitelline->nodes()[k];
      add_block(node, node, -at.contact_forces[k] * model.vitelline->gap(at.positions[node.index()]).hessian);
    }
}

void StepMatrix::add_volume_stiffness(const Model& model, std::span<const Vec3> positions,
                                      std::span<const double> weights) {
  if (weights.empty()) return;
  const auto gradients = model.volumes.element_gradients(positions);
  model.volumes.for_elements(
      [&](std::size_t e) {
        // sum_e 1/V_e (dV_e)^2 >= 1/V_c (sum_e dV_e)^2.
        const std::size_t cell = model.volumes.cell_of(e).index();
        const double weight = weights[cell] * model.tissue.cells[cell].element_count;
        const auto& nodes = model.tissue.elements[e];
        for (int i = 0; i < 8; ++i)
          for (int j = 0; j <= i; ++j)
            add_block(nodes[i], nodes[j], weight * gradients[e][i] * gradients[e][j].transpose());
      },
      takes_apart());
}

double StepMatrix::mean_diagonal() const {
  double sum = 0;
  for (int n = 0; n < layout_.nodes(); ++n) sum += blocks_[layout_.starts[n + 1] - 1].trace();
  return sum / (3 * layout_.nodes());
}

Mat3 StepMatrix::block(std::size_t row, std::size_t column) const {
  if (column > row) return block(column, row).transpose();
  if (static_cast<int>(column) < layout_.columns[layout_.starts[row]]) return Mat3::Zero();  // a row has its diagonal
  const auto first = layout_.columns.begin() + layout_.starts[row],
             last = layout_.columns.begin() + layout_.starts[row + 1];
  const auto at = std::lower_bound(first, last, static_cast<int>(column));
  if (at == last || *at != static_cast<int>(column)) return Mat3::Zero();
  return blocks_[at - layout_.columns.begin()];
}

void StepMatrix::multiply(std::size_t node, const Vec3& direction, std::span<Vec3> product) const {
  for (std::size_t row = 0; row < product.size(); ++row) product[row] = block(row, node) * direction;
}

namespace {

// The diagonal of a fixed unknown: any number will do; one of the block's own size suits the factor's scaling.
double pivot(double own) { return own != 0 ? own : 1; }

}  // namespace

void StepMatrix::write_values(std::span<const NodeFrame> frames, std::vector<double>& values) const {
  values.clear();
  values.reserve(9 * blocks_.size());
  for (std::size_t row = 0; row + 1 < layout_.starts.size(); ++row)
    for (int k = layout_.starts[row]; k < layout_.starts[row + 1]; ++k) {
      const std::size_t column = layout_.columns[k];
      const NodeFrame &a = frames[row], &b = frames[column];
      Mat3 block = blocks_[k];
      if (a.fixed > 0) block = a.axes.transpose() * block;
      if (b.fixed > 0) block = block * b.axes;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (column == row ? i + 1 : 3); ++j) {
          const bool fixed = i < a.fixed || j < b.fixed;
          values.push_back(!fixed ? block(i, j) : column == row && i == j ? pivot(block(i, i)) : 0.0);
        }
    }
  for (std::size_t cell = 0; cell < jacobian_.cells(); ++cell) {
    bool can_change = false;
    for (const auto& [node, gradient] : jacobian_.of_cell(cell)) {
      const NodeFrame& frame = frames[node.index()];
      const Vec3 local = frame.axes.transpose() * gradient;
      for (int j = 0; j < 3; ++j) {
        values.push_back(j < frame.fixed ? 0.0 : -local[j]);
        can_change = can_change || (j >= frame.fixed && local[j] != 0);
      }
    }
    // A cell all of whose nodes are held needs no pressure; a pivot keeps its row from being empty.
    values.push_back(can_change ? 0.0 : -1.0);
  }
}

void StepMatrix::write_projected_blocks(std::span<const NodeFrame> frames, UninitialisedVector<float>& values) const {
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
