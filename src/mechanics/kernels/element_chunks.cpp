#include "mechanics/kernels/element_chunks.hpp"

#include <algorithm>
#include <bitset>

namespace plica {

ElementChunks::ElementChunks(std::span<const std::array<NodeId, 8>> elements, std::span<const CellId> element_cell)
    : elements_(elements.size()), batches_in_chunk_(std::max<std::size_t>(8, (batch_count() - 1) / most_chunks + 1)) {
  using Colours = std::bitset<most_chunks>;
  std::size_t nodes = 0, cells = 0;
  for (const auto& element : elements)
    for (const NodeId node : element) nodes = std::max(nodes, node.index() + 1);
  for (const CellId cell : element_cell) cells = std::max(cells, cell.index() + 1);
  std::vector<Colours> of_node(nodes), of_cell(cells);
  const auto for_all = [&](std::size_t chunk, const auto& take) {
    for (std::size_t e = first_batch(chunk) * batch_size; e < last_element(chunk); ++e) {
      for (const NodeId node : elements[e]) take(of_node[node.index()]);
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

void ElementChunks::put_new_nodes(std::size_t batch, const int (&nodes)[8][batch_size], std::vector<std::size_t>& seen,
                                  NewNodes& new_nodes) const {
  const std::size_t first_of_chunk = batch / batches_in_chunk_ * batches_in_chunk_;
  const std::size_t since = std::max(first_of_chunk + looked_back, batch) - looked_back;
  std::vector<int> found;
  for (const auto& corner : nodes)
    for (const int node : corner) {
      const auto n = static_cast<std::size_t>(node) / 3;
      if (n >= seen.size()) seen.resize(n + 1);
      if (seen[n] <= since) found.push_back(node);
      seen[n] = batch + 1;
    }
  if (found.empty()) found.push_back(nodes[0][0]);
  std::ranges::sort(found);
  const std::size_t room = std::size(new_nodes), asked = std::min(room, found.size());
  for (std::size_t k = 0; k < room; ++k) new_nodes[k] = found[std::min(k, asked - 1) * found.size() / asked];
}

}  // namespace plica
