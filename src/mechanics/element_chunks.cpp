#include "mechanics/element_chunks.hpp"

#include <algorithm>
#include <bitset>

namespace plica {

ElementChunks::ElementChunks(std::span<const std::array<NodeId, 8>> elements)
    : elements_(elements.size()), batches_in_chunk_(std::max<std::size_t>(8, (batch_count() - 1) / most_chunks + 1)) {
  // Each chunk gets the first colour that none of its nodes has yet.
  using Colours = std::bitset<most_chunks>;
  std::size_t nodes = 0;
  for (const auto& element : elements)
    for (const NodeId node : element) nodes = std::max(nodes, node.index() + 1);
  std::vector<Colours> of_node(nodes);
  std::vector<std::vector<std::size_t>> of_colour;
  for (std::size_t chunk = 0; first_batch(chunk) < batch_count(); ++chunk) {
    const auto mine = elements.subspan(first_batch(chunk) * batch_size,
                                       last_element(chunk) - first_batch(chunk) * batch_size);
    Colours taken;
    for (const auto& element : mine)
      for (const NodeId node : element) taken |= of_node[node.index()];
    std::size_t colour = 0;
    while (taken[colour]) ++colour;
    for (const auto& element : mine)
      for (const NodeId node : element) of_node[node.index()].set(colour);
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
