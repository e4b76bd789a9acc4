#include "mechanics/kernels/element_chunks.hpp"

#include <algorithm>
#include <bitset>

namespace plica {

ElementChunks::ElementChunks(std::span<const std::array<NodeId, 8>> elements, std::span<const CellId> element_cell)
    : elements_(elements.size()), batches_in_chunk_(std::max<std::size_t>(8, (batch_count() - 1) / most_chunks + 1)) {
  // Each chunk gets the first colour that none of its nodes and cells has yet.
  using Colours = std::bitset<most_chunks>;
  std::size_t nodes = 0, cells = 0;
  for (const auto& element : elements)
    for (const NodeId node : element) nodes = std::max(nodes, node.index() + 1);
  for (const CellId cell : element_cell) cells = std::max(cells, cell.index() + 1);
  std::vector<Colours> of_node(nodes), of_cell(cells);
  std::vector<std::vector<std::size_t>> of_colour;
  for (std::size_t chunk = 0; first_batch(chunk) < batch_count(); ++chunk) {
    const auto for_all = [&](const auto& take) {
      for (std::size_t e = first_batch(chunk) * batch_size; e < last_element(chunk); ++e) {
        for (const NodeId node : elements[e]) take(of_node[node.index()]);
        if (!element_cell.empty()) take(of_cell[element_cell[e].index()]);
      }
    };
    Colours taken;
    for_all([&](const Colours& colours) { taken |= colours; });
    std::size_t colour = 0;
    while (taken[colour]) ++colour;
    for_all([&](Colours& colours) { colours.set(colour); });
    if (colour == of_colour.size()) of_colour.emplace_back();
    of_colour[colour].push_back(chunk);
  }
  colour_start_.push_back(0);
  for (const auto& chunks : of_colour) {
    order_.insert(order_.end(), chunks.begin(), chunks.end());
    colour_start_.push_back(order_.size());
  }
}

}  // namespace plica
