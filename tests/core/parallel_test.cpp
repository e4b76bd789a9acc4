#include "core/parallel.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <new>
#include <vector>

#include "core/threads.hpp"

namespace plica {
namespace {

TEST(Parallel, FindsTheFirstOnAnyThreads) {
  for (const int count : {1, 2, 4}) {
    const ThreadCount scope(count);
    for (const std::size_t first : {0U, 777U, 60'000U, 99'999U})
      EXPECT_EQ(parallel_find(100'000, [&](std::size_t i) { return i >= first && (i - first) % 1000 == 0; }), first);
    EXPECT_EQ(parallel_find(100'000, [](std::size_t) { return false; }), 100'000U);
    EXPECT_EQ(parallel_find(0, [](std::size_t) { return true; }), 0U);
  }
}

TEST(Parallel, SquaredNormIsThatOfAllVectorsAndTheSameBitsOnAnyThreads) {
  const Vectors vectors(50'001, Vec3(0.1, -0.2, 0.3));
  const auto on = [&](int threads) {
    const ThreadCount scope(threads);
    return parallel_squared_norm(vectors);
  };
  EXPECT_NEAR(on(1), 50'001 * 0.14, 1e-8);
  EXPECT_EQ(on(3), on(1));
}

// Out of a parallel region, where it would end the process: what one iteration throws.
TEST(Parallel, WhatAnIterationThrowsComesOut) {
  int cases = 0;
  for (const int count : {1, 2, 4}) {
    const ThreadCount scope(count);
    EXPECT_THROW(parallel_for(50'000,
                              [](std::size_t i) {
                                if (i == 31'234) throw std::bad_alloc();
                              }),
                 std::bad_alloc);
    std::vector<int> times(50'000, 0);
    parallel_for(times.size(), [&](std::size_t i) { ++times[i]; });
    EXPECT_EQ(std::ranges::count(times, 1), 50'000) << "each once";
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

}  // namespace
}  // namespace plica
