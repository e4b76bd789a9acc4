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

TEST(Program, OnePointHoldsForEver) {
  const Program program({5}, {0.3});
  for (const double time : {0.0, 5.0, 6.0}) EXPECT_EQ(program.at(time), 0.3);
}

}  // namespace
}  // namespace plica
