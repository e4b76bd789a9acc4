#include "mechanics/kernels/element_chunks.hpp"

#include <gtest/gtest.h>

#include <iterator>
#include <set>

#include "mechanics/kernels/corotational_kernels.hpp"

namespace plica {
namespace {

// A sheet of elements, row by row.
std::vector<std::array<NodeId, 8>> sheet(int columns, int rows) {
  std::vector<std::array<NodeId, 8>> elements;
  const auto node = [&](int column, int row, int layer) {
    return NodeId((layer * (rows + 1) + row) * (columns + 1) + column);
  };
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      auto& element = elements.emplace_back();
      for (int layer = 0, corner = 0; layer < 2; ++layer)
        for (const auto [along, across] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}})
          element[corner++] = node(column + along, row + across, layer);
    }
  return elements;
}

std::vector<CorotationalBatch> batches_of(const std::vector<std::array<NodeId, 8>>& elements, std::size_t count) {
  std::vector<CorotationalBatch> batches(count);
  for (std::size_t place = 0; place < 8 * count; ++place)
    for (int i = 0; i < 8; ++i)
      batches[place / 8].nodes[i][place % 8] = 3 * elements[std::min(place, elements.size() - 1)][i].number();
  return batches;
}

std::set<int> nodes_of(const CorotationalBatch& batch) {
  std::set<int> nodes;
  for (const auto& corner : batch.nodes) nodes.insert(std::begin(corner), std::end(corner));
  return nodes;
}

// In rows of 8 batches, of which chunks have five: but for the first one they bring along the 16 nodes of their other
// side. And in rows of 50, further than is looked back: there is no room for all.
TEST(ElementChunks, NewNodesAreThoseThatNoBatchShortlyBeforeHas) {
  for (const auto [columns, rows] : {std::pair{64, 320}, {400, 60}}) {
    const auto elements = sheet(columns, rows);
    const ElementChunks chunks(elements);
    std::vector<CorotationalBatch> batches = batches_of(elements, chunks.batch_count());
    chunks.put_new_nodes(std::span(batches));
    std::size_t full = 0;
    chunks.for_batches([&](std::size_t first, std::size_t last) {
      for (std::size_t b = first; b < last; ++b) {
        std::set<int> expected = nodes_of(batches[b]);
        for (std::size_t before = std::max(first + ElementChunks::looked_back, b) - ElementChunks::looked_back;
             before < b; ++before)
          for (const int node : nodes_of(batches[before])) expected.erase(node);
        const auto& found = batches[b].new_nodes;
        if (expected.size() > std::size(found)) {
          ++full;
          EXPECT_EQ(std::set<int>(std::begin(found), std::end(found)).size(), std::size(found));
          for (const int node : found) EXPECT_TRUE(expected.contains(node)) << "batch " << b;
        } else {
          EXPECT_EQ(std::set<int>(std::begin(found), std::end(found)), expected) << "batch " << b;
        }
      }
    });
    std::printf("%zu of %zu batches have more than there is room for\n", full, batches.size());
    EXPECT_EQ(full < batches.size() / 3, columns == 64);
  }
}

TEST(ElementChunks, ABatchWithoutNewNodesNamesOneThatItHas) {
  const auto one = sheet(4, 1);
  std::vector<std::array<NodeId, 8>> twice;
  for (int round = 0; round < 4; ++round) twice.insert(twice.end(), one.begin(), one.end());
  const ElementChunks chunks(twice);
  std::vector<CorotationalBatch> batches = batches_of(twice, chunks.batch_count());
  chunks.put_new_nodes(std::span(batches));
  ASSERT_EQ(batches.size(), 2u);
  EXPECT_EQ(nodes_of(batches[0]).size(), 20u);
  for (const int node : batches[1].new_nodes) EXPECT_TRUE(nodes_of(batches[1]).contains(node));
}

}  // namespace
}  // namespace plica
