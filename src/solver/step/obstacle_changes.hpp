// Which contacts with obstacles begin or end in one revision of an iterate.
#pragma once

#include <algorithm>
#include <span>
#include <vector>

#include "mechanics/model.hpp"

namespace plica {

/// Rule of changes. Coupled contacts that change all at once may alternate without end, so those that have changed
/// often wait: of nodes that share a cell, one changes per revision. Contacts that still alternate change one at a time
/// in the whole tissue, lowest index first, which terminates for linear forces (Murty 1974).
class ObstacleChanges {
 public:
  static constexpr unsigned char freely = 3, locally = 12;  // number of changes of a contact in a step

  ObstacleChanges(const Tissue& tissue, const ObstacleContacts& contacts) : cell_count_(tissue.cells.size()) {
    std::vector<std::vector<CellId>> of_nodes(tissue.free_node_count());
    for (std::size_t e = 0; e < tissue.elements.size(); ++e)
      for (const NodeId node : tissue.elements[e])
        tissue.for_free_nodes(node, [&, cell = tissue.element_cell[e]](NodeId n, double) {
          std::vector<CellId>& cells = of_nodes[n.index()];
          if (std::ranges::find(cells, cell) == cells.end()) cells.push_back(cell);
        });
    for (std::size_t k = 0; k < contacts.size(); ++k) cells_.push_back(of_nodes[contacts.node(k).index()]);
  }

  /// Change contacts to what is wanted, as far as the rule allows. Returns whether any has changed: one does while any
  /// change is wanted. `changes`: contacts; number of changes in this step, updated here.
  bool make(std::span<const char> wanted, std::span<unsigned char> changes, std::span<char> on_obstacle) const {
    std::vector<std::size_t> waiting;
    std::vector<char> is_taken(cell_count_, 0);  // by a change
    bool changed = false;
    const auto change = [&](std::size_t k) {
      on_obstacle[k] = wanted[k];
      changes[k] = std::min<unsigned char>(changes[k] + 1, locally);
      for (const CellId cell : cells_[k]) is_taken[cell.index()] = 1;
      changed = true;
    };
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      if (wanted[k] == on_obstacle[k]) continue;
      if (changes[k] < freely)
        change(k);
      else
        waiting.push_back(k);
    }
    const auto is_free = [&](CellId cell) { return is_taken[cell.index()] == 0; };
    for (const std::size_t k : waiting)
      if (changes[k] < locally && std::ranges::all_of(cells_[k], is_free)) change(k);
    if (!changed && !waiting.empty()) change(waiting.front());
    return changed;
  }

 private:
  std::size_t cell_count_;
  std::vector<std::vector<CellId>> cells_;  // contacts: cells of the node
};

}  // namespace plica
