#include "mechanics/kernels/element_chunks.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "core/threads.hpp"
#include "tissue/tissue.hpp"

namespace plica {
namespace {

/// Elements that have no node in common. The last node of each hangs: on one free node for all of them, or on its own
/// element's first.
Tissue elements_that_hang(int count, bool on_one) {
  Tissue tissue;
  tissue.rest_positions.assign(8 * count, Vec3::Zero());
  for (int e = 0; e < count; ++e) {
    std::array<NodeId, 8> nodes;
    for (int i = 0; i < 7; ++i) nodes[i] = NodeId(7 * e + i);
    nodes[7] = NodeId(7 * count + e);
    tissue.elements.push_back(nodes);
    tissue.hanging.push_back({{on_one ? NodeId(0) : nodes[0], 1.0}});
  }
  return tissue;
}

/// Whether two threads are ever in chunks of these elements at once.
bool overlaps(const Tissue& tissue) {
  const ThreadCount scope(4);
  std::atomic<int> inside = 0;
  std::atomic<bool> overlap = false;
  ElementChunks(tissue, tissue.elements).for_batches([&](std::size_t, std::size_t) {
    if (++inside > 1) overlap = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    --inside;
  });
  return overlap;
}

TEST(ElementChunks, ThoseThatHangOnTheSameNodeAreNotTakenAtOnce) {
  constexpr int worth_sharing = 4096;
  EXPECT_TRUE(overlaps(elements_that_hang(worth_sharing, false)));
  EXPECT_FALSE(overlaps(elements_that_hang(worth_sharing, true)));
}

}  // namespace
}  // namespace plica
