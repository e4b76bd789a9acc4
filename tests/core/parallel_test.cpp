#include "core/parallel.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

TEST(Parallel, FindsTheFirstOnAnyThreads) {
  const int threads = omp_get_max_threads();
  for (const int count : {1, 2, 4}) {
    omp_set_num_threads(count);
    for (const std::size_t first : {0U, 777U, 60'000U, 99'999U})
      EXPECT_EQ(parallel_find(100'000, [&](std::size_t i) { return i >= first && (i - first) % 1000 == 0; }), first);
    EXPECT_EQ(parallel_find(100'000, [](std::size_t) { return false; }), 100'000U);
    EXPECT_EQ(parallel_find(0, [](std::size_t) { return true; }), 0U);
  }
  omp_set_num_threads(threads);
}

TEST(Parallel, SquaredNormIsThatOfAllVectorsAndTheSameBitsOnAnyThreads) {
  const Vectors vectors(50'001, Vec3(0.1, -0.2, 0.3));
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const double alone = parallel_squared_norm(vectors);
  EXPECT_NEAR(alone, 50'001 * 0.14, 1e-8);
  omp_set_num_threads(3);
  EXPECT_EQ(parallel_squared_norm(vectors), alone);
  omp_set_num_threads(threads);
}

}  // namespace
}  // namespace plica
