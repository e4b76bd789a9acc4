#include "solver/step_matrix.hpp"

#include <algorithm>

namespace plica {

StepMatrix::StepMatrix(const Model& model) : tissue_(model.tissue) {
  const int nodes = static_cast<int>(tissue_.free_node_count());
  // Which blocks can be non-zero: pairs within the laws' groups of nodes, and every node with itself.
  std::vector<std::vector<int>> lower(nodes);
  for (int n = 0; n < nodes; ++n) lower[n].push_back(n);
  std::vector<NodeId> free;
  const auto join = [&](const std::vector<NodeId>& group) {
    free.clear();
    for (const NodeId node : group) tissue_.for_free_nodes(node, [&](NodeId n, double) { free.push_back(n); });
    for (const NodeId a : free)
      for (const NodeId b : free)
        if (b < a) lower[a.index()].push_back(b.number());
  };
  for (const auto& law : model.laws)
    for (const auto& group : law->node_groups()) join(group);
  if (model.volumes_are_held)
    for (const auto& element : tissue_.elements) join({element.begin(), element.end()});
  row_start_.push_back(0);
  for (auto& row : lower) {
    std::sort(row.begin(), row.end());
    row.erase(std::unique(row.begin(), row.end()), row.end());
    columns_.insert(columns_.end(), row.begin(), row.end());
    row_start_.push_back(static_cast<int>(columns_.size()));
  }
  blocks_.resize(columns_.size());

  // The nodes of each cell, for its volume's gradient.
  gradient_start_.push_back(0);
  element_slots_.resize(tissue_.elements.size());
  for (const Cell& cell : tissue_.cells) {
    if (!model.volumes_are_held) break;
    std::vector<NodeId> members;
    const auto first = cell.first_element.index();
    for (std::size_t e = first; e < first + cell.element_count; ++e)
      for (const NodeId node : tissue_.elements[e])
        tissue_.for_free_nodes(node, [&](NodeId n, double) { members.push_back(n); });
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    const int offset = static_cast<int>(gradients_.size());
    for (std::size_t e = first; e < first + cell.element_count; ++e)
      for (int i = 0; i < 8; ++i)
        tissue_.for_free_nodes(tissue_.elements[e][i], [&](NodeId n, double weight) {
          const auto at = std::lower_bound(members.begin(), members.end(), n);
          const int slot = offset + static_cast<int>(at - members.begin());
          const bool hangs = n != tissue_.elements[e][i];
          element_slots_[e][i] = hangs ? -1 : slot;
          if (hangs) hanging_slots_.push_back({e, i, slot, weight});
        });
    for (const NodeId node : members) gradients_.push_back({node, Vec3::Zero()});
    gradient_start_.push_back(static_cast<int>(gradients_.size()));
  }

  // Scalar entries, in the order of write_values.
  const int cells = static_cast<int>(gradient_start_.size()) - 1;
  pattern_.size = 3 * nodes + cells;
  const auto entry = [&](int row, int column) {
    pattern_.rows.push_back(row);
    pattern_.columns.push_back(column);
  };
  for (int row = 0; row < nodes; ++row)
    for (int k = row_start_[row]; k < row_start_[row + 1]; ++k)
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < (columns_[k] == row ? i + 1 : 3); ++j) entry(3 * row + i, 3 * columns_[k] + j);
  for (int cell = 0; cell < cells; ++cell) {
    for (int k = gradient_start_[cell]; k < gradient_start_[cell + 1]; ++k)
      for (int j = 0; j < 3; ++j) entry(3 * nodes + cell, 3 * gradients_[k].node.number() + j);
    entry(3 * nodes + cell, 3 * nodes + cell);
  }
}

void StepMatrix::set_zero() { std::fill(blocks_.begin(), blocks_.end(), Mat3::Zero()); }

void StepMatrix::add_block(NodeId row, NodeId column, const Mat3& block) {
  const std::size_t free = tissue_.free_node_count();
  if (row.index() < free && column.index() < free) return add_free_block(row, column, block);
  tissue_.for_free_nodes(row, [&](NodeId r, double weight_r) {
    tissue_.for_free_nodes(column,
                           [&](NodeId c, double weight_c) { add_free_block(r, c, weight_r * weight_c * block); });
  });
}

void StepMatrix::add_free_block(NodeId row, NodeId column, const Mat3& block) {
  if (column > row) return;
  const auto first = columns_.begin() + row_start_[row.index()], last = columns_.begin() + row_start_[row.index() + 1];
  blocks_[std::lower_bound(first, last, column.number()) - columns_.begin()] += block;
}

void StepMatrix::set_volume_gradients(const CellVolumes& volumes, std::span<const Vec3> positions) {
  if (gradients_.empty()) return;
  for (Gradient& gradient : gradients_) gradient.value.setZero();
  const auto of_elements = volumes.element_gradients(positions);
  for (std::size_t e = 0; e < of_elements.size(); ++e)
    for (int i = 0; i < 8; ++i)
      if (element_slots_[e][i] >= 0) gradients_[element_slots_[e][i]].value += of_elements[e][i];
  for (const auto& [element, corner, slot, weight] : hanging_slots_)
    gradients_[slot].value += weight * of_elements[element][corner];
}

void StepMatrix::multiply(std::span<const Vec3> direction, std::span<Vec3> product) const {
  std::fill(product.begin(), product.end(), Vec3::Zero());
  for (std::size_t row = 0; row + 1 < row_start_.size(); ++row)
    for (int k = row_start_[row]; k < row_start_[row + 1]; ++k) {
      const std::size_t column = columns_[k];
      product[row] += blocks_[k] * direction[column];
      if (column != row) product[column] += blocks_[k].transpose() * direction[row];
    }
}

std::vector<double> StepMatrix::volume_rates(std::span<const Vec3> direction) const {
  std::vector<double> rates(gradient_start_.size() - 1, 0.0);
  for (std::size_t cell = 0; cell < rates.size(); ++cell)
    for (int k = gradient_start_[cell]; k < gradient_start_[cell + 1]; ++k)
      rates[cell] += gradients_[k].value.dot(direction[gradients_[k].node.index()]);
  return rates;
}

void StepMatrix::add_pressure_forces(std::span<const double> pressures, std::span<Vec3> forces) const {
  for (std::size_t cell = 0; cell + 1 < gradient_start_.size(); ++cell)
    for (int k = gradient_start_[cell]; k < gradient_start_[cell + 1]; ++k)
      forces[gradients_[k].node.index()] += pressures[cell] * gradients_[k].value;
}

namespace {

// The diagonal of a fixed unknown: any number will do; one of the block's own size suits the factor's scaling.
double pivot(double own) { return own != 0 ? own : 1; }

}  // namespace

void StepMatrix::write_values(std::span<const NodeFrame> frames, std::vector<double>& values) const {
  values.clear();
  values.reserve(pattern_.rows.size());
  for (std::size_t row = 0; row + 1 < row_start_.size(); ++row)
    for (int k = row_start_[row]; k < row_start_[row + 1]; ++k) {
      const std::size_t column = columns_[k];
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
  for (std::size_t cell = 0; cell + 1 < gradient_start_.size(); ++cell) {
    bool can_change = false;
    for (int k = gradient_start_[cell]; k < gradient_start_[cell + 1]; ++k) {
      const NodeFrame& frame = frames[gradients_[k].node.index()];
      const Vec3 local = frame.axes.transpose() * gradients_[k].value;
      for (int j = 0; j < 3; ++j) {
        values.push_back(j < frame.fixed ? 0.0 : -local[j]);
        can_change = can_change || (j >= frame.fixed && local[j] != 0);
      }
    }
    // A cell all of whose nodes are held needs no pressure; a pivot keeps its row from being empty.
    values.push_back(can_change ? 0.0 : -1.0);
  }
}

}  // namespace plica
