#include "measure/speed_history.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace plica {
namespace {

/// A step: the speeds of VML and VCE, and their displacements.
SpeedRow row(double time_s, double vml_speed, double vce_speed, double vml_displacement, double vce_displacement) {
  return {time_s, vml_speed, vce_speed, vml_displacement, vce_displacement};
}

/// The ends lead by most at 2 s, three to one; both are as fast at 4 s, halfway between two rows.
std::vector<SpeedRow> ends_first() {
  return {SpeedRow{},  // at rest, without speeds
          row(1, 1, 2, 1, 2), row(2, 2, 6, 3, 8), row(3, 5, 7, 10, 30), row(5, 8, 6, 20, 34), row(6, 4, 5, 24, 39)};
}

TEST(SpeedHistory, EndsLeadMostAtThePeakAndUntilSpeedsAreEqual) {
  const SpeedHistory history = speed_history(ends_first());
  EXPECT_DOUBLE_EQ(history.peak_ratio.value(), 3);
  EXPECT_EQ(history.peak_ratio_time_s.value(), 2);
  EXPECT_DOUBLE_EQ(history.ends_lead_until_s.value(), 4);
  EXPECT_DOUBLE_EQ(history.vml_displacement_at_equal_speed_um.value(), 15);
  EXPECT_DOUBLE_EQ(history.vce_displacement_at_equal_speed_um.value(), 32);
}

TEST(SpeedHistory, StepsInWhichTheMiddleHardlyMovesAreNoPeak) {
  std::vector<SpeedRow> rows = ends_first();
  const double limit = 0.01 * 8;  // 1 % of the middle's fastest
  rows.insert(rows.begin() + 1, row(0.5, limit, 50, 0.1, 9));
  EXPECT_EQ(speed_history(rows).peak_ratio_time_s.value(), 2);
  rows[1] = row(0.5, 1.01 * limit, 50, 0.1, 9);
  EXPECT_EQ(speed_history(rows).peak_ratio_time_s.value(), 0.5);
}

TEST(SpeedHistory, SpeedsThatAreEqualInARowMeetThere) {
  const std::vector<SpeedRow> rows = {row(1, 1, 3, 1, 3), row(2, 4, 4, 5, 7), row(3, 5, 4, 10, 11)};
  const SpeedHistory history = speed_history(rows);
  EXPECT_EQ(history.ends_lead_until_s.value(), 2);
  EXPECT_EQ(history.vml_displacement_at_equal_speed_um.value(), 5);
  EXPECT_EQ(history.vce_displacement_at_equal_speed_um.value(), 7);
}

TEST(SpeedHistory, AMiddleThatMovesByRoundingOnlyHasNoRatio) {
  EXPECT_FALSE(row(1, 4.5e-23, 0.96, 0, 0).speed_ratio());
  EXPECT_FALSE(row(1, 0, 0, 0, 0).speed_ratio());
  EXPECT_DOUBLE_EQ(*row(1, 0.1, 0.3, 0, 0).speed_ratio(), 0.3 / 0.1);
}

TEST(SpeedHistory, WhatNeverHappensHasNoValue) {
  for (const auto& rows : {std::vector<SpeedRow>{}, {SpeedRow{}}, {row(1, 0, 0, 0, 0)}}) {
    const SpeedHistory none = speed_history(rows);
    EXPECT_FALSE(none.peak_ratio || none.peak_ratio_time_s || none.ends_lead_until_s);
  }
  const std::vector<SpeedRow> to_the_end = {row(1, 1, 3, 1, 3), row(2, 4, 5, 5, 8)};
  const SpeedHistory leading = speed_history(to_the_end);
  EXPECT_EQ(leading.peak_ratio_time_s.value(), 1);
  EXPECT_FALSE(leading.ends_lead_until_s || leading.vml_displacement_at_equal_speed_um ||
               leading.vce_displacement_at_equal_speed_um);
}

}  // namespace
}  // namespace plica
