#include "mechanics/active/program.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

TEST(Program, IsAlwaysOneByDefault) {
  for (const double time : {0.0, 1.0, 1e6}) EXPECT_EQ(Program().at(time), 1);
  EXPECT_EQ(Program().end_s(), 0);
}

TEST(Program, IsLinearBetweenPointsAndHeldOutside) {
  const Program program({10, 20, 40}, {0.5, 1.0, 0.0});
  int cases = 0;
  for (const auto& [time, activity] : {std::pair{0.0, 0.5},
                                       {10.0, 0.5},
                                       {12.0, 0.6},
                                       {20.0, 1.0},
                                       {30.0, 0.5},
                                       {39.0, 0.05},
                                       {40.0, 0.0},
                                       {1e6, 0.0}}) {
    EXPECT_NEAR(program.at(time), activity, 1e-14) << "at " << time;
    ++cases;
  }
  EXPECT_EQ(program.end_s(), 40);
  RecordProperty("cases", cases);
}

// At a jump the activity is still that before it: a step that ends there is not yet of the new one.
TEST(Program, JumpsBetweenTwoPointsOfOneTime) {
  const Program program({0, 0, 10, 20, 20}, {0.2, 0.4, 1.0, 1.0, 0.1});
  int cases = 0;
  for (const auto& [time, activity] : {std::pair{0.0, 0.2},
                                       {0.001, 0.40006},
                                       {5.0, 0.7},
                                       {10.0, 1.0},
                                       {20.0, 1.0},
                                       {20 + 1e-9, 1.0},  // rounding of the clock
                                       {20 + 1e-5, 0.1},
                                       {1e6, 0.1}}) {
    EXPECT_NEAR(program.at(time), activity, 1e-14) << "at " << time;
    ++cases;
  }
  RecordProperty("cases", cases);
  EXPECT_EQ(program.jumps_s(), (std::vector<double>{0, 20}));
  EXPECT_TRUE(Program({10, 20, 40}, {0.5, 1.0, 0.0}).jumps_s().empty());
}

TEST(Program, OnePointHoldsForEver) {
  const Program program({5}, {0.3});
  for (const double time : {0.0, 5.0, 6.0}) EXPECT_EQ(program.at(time), 0.3);
}

}  // namespace
}  // namespace plica
