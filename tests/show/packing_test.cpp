#include "show/packing.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace plica {
namespace {

TEST(PackedArrays, KeepsDifferencesBytePlaneByBytePlane) {
  PackedArrays arrays;
  const std::vector<std::uint16_t> small = {0x0102, 0x0304, 0x0103, 0x0300};
  const std::vector<std::uint32_t> large = {0x01020304, 0x01020303};
  arrays.add("small", std::span<const std::uint16_t>(small), 2);
  arrays.add("large", std::span<const std::uint32_t>(large), 1);
  // Differences: 0102 0304 0001 fffc, then 01020304 ffffffff; lowest bytes first.
  EXPECT_EQ(arrays.bytes(), std::string("\x02\x04\x01\xfc\x01\x03\x00\xff\x04\xff\x03\xff\x02\xff\x01\xff", 16));
  const auto index = arrays.index();
  EXPECT_EQ(index[1]["name"], "large");
  EXPECT_EQ(index[1]["bits"], 32);
  EXPECT_EQ(index[1]["offset"], 8);
  EXPECT_EQ(index[1]["count"], 2);
}

TEST(Quantiser, IsExactAtItsEndsAndWithinHalfAStepBetween) {
  Quantiser range;
  EXPECT_EQ(range.step_of(3), 0);  // nothing known yet
  for (const double value : {-2.0, 5.0, 1.0}) range.include(value);
  EXPECT_EQ(range.step_of(-2), 0);
  EXPECT_EQ(range.step_of(5), 65535);
  EXPECT_EQ(range.step_of(7), 65535);
  for (const double value : {-1.9, 0.0, 3.3333}) {
    const double back = -2 + 7.0 * range.step_of(value) / 65535;
    EXPECT_NEAR(back, value, 0.5 * 7 / 65535 * (1 + 1e-9));
  }
}

}  // namespace
}  // namespace plica
