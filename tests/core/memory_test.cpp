#include "core/memory.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace plica {
namespace {

TEST(PeakMemory, GrowsWithWhatIsTakenAndStays) {
  const double before_MB = peak_memory_MB();
  EXPECT_GT(before_MB, 1);
  EXPECT_LT(before_MB, 1e5);
  const double much_MB = before_MB + 50;  // more than ever
  {
    std::vector<char> block(static_cast<std::size_t>(much_MB * 1e6), 1);
    EXPECT_EQ(block.back(), 1);
  }
  EXPECT_GE(peak_memory_MB(), much_MB);
}

}  // namespace
}  // namespace plica
