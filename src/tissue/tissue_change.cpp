#include "tissue/tissue_change.hpp"

namespace plica {

TissueChange no_change(const Tissue& tissue) {
  TissueChange change;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) change.origin.emplace_back(c);
  for (std::size_t w = 0; w < tissue.sheet.walls.size(); ++w) change.wall_origin.emplace_back(w);
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) change.node_origin.emplace_back(n);
  return change;
}

std::vector<std::size_t> first_facets(std::span<const Facet> facets, std::size_t cells) {
  std::vector<std::size_t> first(cells + 1, 0);
  for (const Facet& facet : facets) ++first[facet.cell.index() + 1];
  for (std::size_t c = 0; c < cells; ++c) first[c + 1] += first[c];
  return first;
}

std::vector<std::optional<std::size_t>> former_facets(const TissueChange& change, std::size_t cells_before,
                                                      std::span<const Facet> before, std::span<const Facet> after) {
  const std::vector<std::size_t> former = first_facets(before, cells_before),
                                 present = first_facets(after, change.origin.size());
  std::vector<char> is_new(change.origin.size(), 0);
  for (const auto& [low, high] : change.daughters) is_new[low.index()] = is_new[high.index()] = 1;
  std::vector<std::optional<std::size_t>> numbers;
  for (std::size_t f = 0; f < after.size(); ++f) {
    const std::size_t cell = after[f].cell.index(), origin = change.origin[cell].index();
    const bool stays = !change.is_remeshed(after[f].cell) && is_new[cell] == 0 &&
                       present[cell + 1] - present[cell] == former[origin + 1] - former[origin];
    numbers.push_back(stays ? std::optional(former[origin] + f - present[cell]) : std::nullopt);
  }
  return numbers;
}

Vectors with_new_nodes(const Tissue& tissue, const TissueChange& change, const Vectors& before) {
  Vectors after;
  for (const NodeId node : change.node_origin) after.push_back(before[node.index()]);
  for (const NodeMean& place : change.new_nodes) after.push_back(mean_of(place, after));
  after.resize(tissue.node_count(), Vec3::Zero());
  tissue.place_hanging(after);
  return after;
}

}  // namespace plica
