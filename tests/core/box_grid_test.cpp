#include "core/box_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace plica {
namespace {

std::vector<Box> random_boxes(int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> place(-30, 30), size(0, 9);
  std::vector<Box> boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 low(place(random), place(random), place(random));
    boxes.push_back({low, low + Vec3(size(random), size(random), i % 7 == 0 ? 0 : size(random))});
  }
  return boxes;
}

TEST(BoxGrid, FindsWhatOverlapsEachOnce) {
  const std::vector<Box> boxes = random_boxes(400);
  for (const double size : {0.7, 3.0, 50.0}) {
    const BoxGrid grid(size, boxes);
    std::vector<std::uint32_t> found, expected;
    std::size_t pairs = 0;
    for (const Box& box : boxes) {
      expected.clear();
      for (std::uint32_t b = 0; b < boxes.size(); ++b)
        if (boxes[b].overlaps(box)) expected.push_back(b);
      grid.find_overlapping(box, found);
      EXPECT_EQ(found, expected);
      pairs += found.size();
      std::erase_if(expected, [](std::uint32_t b) { return b < 100; });
      grid.find_overlapping(box, found, 100);
      EXPECT_EQ(found, expected);
    }
    EXPECT_GT(pairs, 2 * boxes.size());
  }
}

TEST(BoxGrid, NearAPlaceAreAllBoxesThatHoldIt) {
  const std::vector<Box> boxes = random_boxes(400);
  const BoxGrid grid(2, boxes);
  std::size_t held = 0;
  for (const Box& box : random_boxes(300)) {
    const std::span<const std::uint32_t> near = grid.near(box.low);
    EXPECT_TRUE(std::ranges::is_sorted(near));
    for (std::uint32_t b = 0; b < boxes.size(); ++b) {
      if (!boxes[b].overlaps({box.low, box.low})) continue;
      EXPECT_TRUE(std::ranges::binary_search(near, b));
      ++held;
    }
  }
  EXPECT_GT(held, 300U);
}

TEST(BoxGrid, WithoutBoxesNothingIsFound) {
  std::vector<std::uint32_t> found = {1};
  for (const BoxGrid& grid : {BoxGrid(), BoxGrid(1, {})}) {
    grid.find_overlapping({{0, 0, 0}, {1, 1, 1}}, found);
    EXPECT_TRUE(found.empty() && grid.near({0, 0, 0}).empty());
  }
}

}  // namespace
}  // namespace plica
