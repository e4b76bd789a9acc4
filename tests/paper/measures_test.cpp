// Figures that are read off a run between its rows.
#include "paper/measures.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

Series of_rows(std::vector<std::vector<std::optional<double>>> rows) {
  return {{"time_s", "vml_displacement_um", "vce_displacement_um", "max_node_speed_um_per_s", "furrow_depth_um"},
          std::move(rows)};
}

// The middle is in 7-10 um from 7 s to 10 s, the ends in 13-17 um from 6.5 s to 8.5 s. No row lies in both.
TEST(PrintedTimes, LieBetweenRows) {
  const Figures figures = printed_times(of_rows({{0, 0, 0, 0, 0}, {5, 5, 10, 0.5, 10}, {15, 15, 30, 0.1, 20}}));
  EXPECT_NEAR(figures.at("both_in_range_from_s"), 7, 1e-12);
  EXPECT_NEAR(figures.at("both_in_range_until_s"), 8.5, 1e-12);
  EXPECT_NEAR(figures.at("slower_than_printed_s"), 12.5, 1e-12);
  EXPECT_NEAR(figures.at("depth_then_um"), 17.5, 1e-12);
}

// Slower once, faster again: the first time counts. A middle that stands still has to stand in its range.
TEST(PrintedTimes, AreTheFirst) {
  const Figures figures =
      printed_times(of_rows({{0, 8, 12, 0.4, 0}, {2, 8, 14, 0.0, 2}, {3, 8, 14, 0.6, 3}, {4, 8, 18, 0.1, 4}}));
  EXPECT_NEAR(figures.at("both_in_range_from_s"), 1, 1e-12);
  EXPECT_NEAR(figures.at("both_in_range_until_s"), 3.75, 1e-12);
  EXPECT_NEAR(figures.at("slower_than_printed_s"), 1, 1e-12);
}

TEST(PrintedTimes, MayNotBe) {
  const Figures figures = printed_times(of_rows({{0, 0, 0, 0.4, 0}, {2, 6, {}, 0.3, 2}, {3, 11, 14, 0.3, 3}}));
  EXPECT_TRUE(figures.empty());
}

}  // namespace
}  // namespace plica
