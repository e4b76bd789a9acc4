#include "record/csv.hpp"

#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdio>
#include <limits>
#include <random>
#include <vector>

namespace plica {
namespace {

std::string as_printf(double value) {
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%.10g", value);
  return text.data();
}

std::string number(double value) { return csv_rows(std::span<const double>(&value, 1), 1); }

TEST(Csv, NumbersAreAsPrintfGivesThem) {
  std::mt19937_64 random(7);
  std::vector<double> values = {1,    -1,   0.1,    1e9,        1e9 - 1,  1e10,   1e15, 123456789.5, 9999999999.5,
                                1e-4, 1e-5, 2.5e-7, 1e300,      5e-324,   1e-300, 0.5,  755,         1234567890.125,
                                -1e9, 1e22, 1e-10,  4294967296, 0.1 + 0.2};
  std::uniform_real_distribution<double> near(-500, 500);
  for (int i = 0; i < 20000; ++i) {
    values.push_back(near(random));
    const double any = std::bit_cast<double>(random());  // any bits
    if (std::isfinite(any)) values.push_back(any);
  }
  for (const double value : values) ASSERT_EQ(number(value), as_printf(value));
  RecordProperty("cases", static_cast<int>(values.size()));
}

TEST(Csv, WhatIsNotFiniteIsLeftEmptyAndZeroHasNoSign) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  const std::vector<double> values = {nan, 1.5, -infinite, -0.0, 2, nan};
  EXPECT_EQ(csv_rows(values, 6), ",1.5,,0,2,");
  EXPECT_EQ(csv_rows(values, 3), ",1.5,\n0,2,");
  EXPECT_EQ(csv_rows({}, 3), "");
}

}  // namespace
}  // namespace plica
