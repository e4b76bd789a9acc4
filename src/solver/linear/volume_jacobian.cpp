#include "solver/linear/volume_jacobian.hpp"

#include <algorithm>

#include "core/parallel.hpp"

namespace plica {

VolumeJacobian::VolumeJacobian(const Model& model) : start_{0}, node_start_(model.tissue.free_node_count() + 1, 0) {
  if (!model.volumes_are_held) return;
  const Tissue& tissue = model.tissue;
  element_slots_.resize(tissue.elements.size());
  start_.reserve(tissue.cells.size() + 1);
  gradients_.reserve(8 * tissue.cells.size());  // or more, where cells are cut
  std::vector<NodeId> members;
  for (const Cell& cell : tissue.cells) {
    members.clear();
    const auto first = cell.first_element.index();
    for (std::size_t e = first; e < first + cell.element_count; ++e)
      for (const NodeId node : tissue.elements[e])
        tissue.for_free_nodes(node, [&](NodeId n, double) { members.push_back(n); });
    std::sort(members.begin(), members.end());
    members.erase(std::unique(members.begin(), members.end()), members.end());
    const int offset = static_cast<int>(gradients_.size());
    for (std::size_t e = first; e < first + cell.element_count; ++e)
      for (int i = 0; i < 8; ++i)
        tissue.for_free_nodes(tissue.elements[e][i], [&](NodeId n, double weight) {
          const auto at = std::lower_bound(members.begin(), members.end(), n);
          const int slot = offset + static_cast<int>(at - members.begin());
          const bool hangs = n != tissue.elements[e][i];
          element_slots_[e][i] = hangs ? -1 : slot;
          if (hangs) hanging_slots_.push_back({e, i, slot, weight});
        });
    for (const NodeId node : members) gradients_.push_back({node, Vec3::Zero()});
    start_.push_back(gradients_.size());
  }
  for (const Gradient& gradient : gradients_) ++node_start_[gradient.node.index() + 1];
  for (std::size_t n = 0; n + 1 < node_start_.size(); ++n) node_start_[n + 1] += node_start_[n];
  touches_.resize(gradients_.size());
  std::vector<std::size_t> next(node_start_.begin(), node_start_.end() - 1);
  for (int cell = 0; cell < static_cast<int>(cells()); ++cell) {
    int slot = 0;
    for (const Gradient& gradient : of_cell(cell)) touches_[next[gradient.node.index()]++] = {cell, slot++};
  }
}

void VolumeJacobian::update(const CellVolumes& volumes, std::span<const Vec3> positions) {
  if (gradients_.empty()) return;
  parallel_for(gradients_.size(), [&](std::size_t slot) { gradients_[slot].value.setZero(); });
  const auto of_elements = volumes.element_gradients(positions);
  volumes.for_elements(
      [&](std::size_t e) {
        for (int i = 0; i < 8; ++i)
          if (element_slots_[e][i] >= 0) gradients_[element_slots_[e][i]].value += of_elements[e][i];
      },
      true);
  for (const auto& [element, corner, slot, weight] : hanging_slots_)
    gradients_[slot].value += weight * of_elements[element][corner];
}

void VolumeJacobian::rates(std::span<const Vec3> direction, std::span<double> rates) const {
  parallel_for(cells(), [&](std::size_t cell) { rates[cell] = rate(cell, direction); });
}

void VolumeJacobian::add_rates(std::span<const Vec3> direction, std::span<const double> weights, double factor,
                               std::span<double> to) const {
  parallel_for(cells(), [&](std::size_t cell) { to[cell] += factor * weights[cell] * rate(cell, direction); });
}

// A node gets the forces of its cells in their order, either way, so that threads change no bit.
void VolumeJacobian::add_forces(std::span<const double> pressures, double factor, std::span<Vec3> forces) const {
  const std::size_t nodes = node_start_.size() - 1;
  constexpr std::size_t worth_sharing = 8192;  // nodes; cell by cell is faster on one thread
  if (nodes < worth_sharing || omp_get_max_threads() == 1) {
    for (std::size_t cell = 0; cell < cells(); ++cell) {
      const double pressure = factor * pressures[cell];
      for (const Gradient& gradient : of_cell(cell)) forces[gradient.node.index()] += pressure * gradient.value;
    }
    return;
  }
  parallel_for(nodes, [&](std::size_t node) {
    for (const auto& [cell, slot] : around(node)) {
      const double pressure = factor * pressures[cell];
      forces[node] += pressure * of_cell(cell)[slot].value;
    }
  });
}

}  // namespace plica
