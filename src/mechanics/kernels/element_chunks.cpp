#include "mechanics/kernels/element_chunks.hpp"

#include <bitset>

#include "tissue/tissue.hpp"

namespace plica {

ElementChunks::ElementChunks(const Tissue& tissue, std::span<const std::array<NodeId, 8>> elements,
                             std::span<const CellId> element_cell)
    : elements_(elements.size()), batches_in_chunk_(std::max<std::size_t>(8, (batch_count() - 1) / most_chunks + 1)) {
  using Colours = std::bitset<most_chunks>;
  std::size_t cells = 0;
  for (const CellId cell : element_cell) cells = std::max(cells, cell.index() + 1);
  std::vector<Colours> of_node(tissue.free_node_count()), of_cell(cells);
  const auto for_all = [&](std::size_t chunk, const auto& take) {
    for (std::size_t e = first_batch(chunk) * batch_size; e < last_element(chunk); ++e) {
      for (const NodeId node : elements[e])  // what shares a hanging node shares those that it hangs on
        tissue.for_free_nodes(node, [&](NodeId free, double) { take(of_node[free.index()]); });
      if (!element_cell.empty()) take(of_cell[element_cell[e].index()]);
    }
  };
  // Each chunk gets the first colour that none of its nodes and cells has yet.
  const std::size_t chunks = (batch_count() + batches_in_chunk_ - 1) / batches_in_chunk_;
  std::vector<std::vector<std::size_t>> of_colour;
  for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
    Colours taken;
    for_all(chunk, [&](const Colours& colours) { taken |= colours; });
    std::size_t colour = 0;
    while (taken[colour]) ++colour;
    for_all(chunk, [&](Colours& colours) { colours.set(colour); });
    if (colour == of_colour.size()) of_colour.emplace_back();
    of_colour[colour].push_back(chunk);
  }
  phase_start_.push_back(0);
  for (const auto& of_one : of_colour) {
    order_.insert(order_.end(), of_one.begin(), of_one.end());
    phase_start_.push_back(order_.size());
  }
}

}  // namespace plica
