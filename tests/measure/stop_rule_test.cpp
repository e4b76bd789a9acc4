#include "measure/stop_rule.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

Reading reading(std::vector<double> values) {
  const auto number = combined(Over::mean, values);
  return {std::move(values), number};
}

Criterion above(double bound, Criterion::Over over = Criterion::Over::number) { return {"c", 0, bound, {}, over}; }

TEST(StopRule, ABoundOnTheNumberOnAnyAndOnAll) {
  const Reading values = reading({1, 2, 9});  // mean 4
  using Over = Criterion::Over;
  EXPECT_TRUE(above(3.9).is_met(values));
  EXPECT_FALSE(above(4).is_met(values)) << "beyond, not at";
  EXPECT_TRUE(above(8, Over::any).is_met(values)) << "one suffices";
  EXPECT_FALSE(above(9, Over::any).is_met(values));
  EXPECT_TRUE(above(0.5, Over::all).is_met(values));
  EXPECT_FALSE(above(1, Over::all).is_met(values)) << "one is missing";
  const Criterion below{"c", 0, {}, 2, Over::any};
  EXPECT_TRUE(below.is_met(values));
  EXPECT_FALSE(below.is_met(reading({2, 3})));
  const Criterion between{"c", 0, 3, 5, Over::number};
  EXPECT_TRUE(between.is_met(values));
  EXPECT_FALSE(between.is_met(reading({5})));
  EXPECT_FALSE(between.is_met(reading({3})));
}

TEST(StopRule, WhatHasNoValueMeetsNothing) {
  for (const auto over : {Criterion::Over::number, Criterion::Over::any, Criterion::Over::all})
    EXPECT_FALSE(above(-1e300, over).is_met(reading({})));
}

TEST(StopRule, CombinesCriteriaAndRest) {
  StopRule rule;
  EXPECT_FALSE(rule.is_over(0, true)) << "without criteria, the loop decides";
  rule.criteria = {{"high", 0, 10, {}, {}}, {"low", 1, {}, 1, {}}};
  const std::vector<Reading> one = {reading({11}), reading({2})}, both = {reading({11}), reading({0})};
  EXPECT_EQ(rule.met(one), std::vector<std::string>{"high"});
  EXPECT_EQ(rule.met(both), (std::vector<std::string>{"high", "low"}));
  EXPECT_TRUE(rule.is_over(1, false));
  EXPECT_FALSE(rule.is_over(0, true));
  rule.all = true;
  EXPECT_FALSE(rule.is_over(1, true));
  EXPECT_TRUE(rule.is_over(2, false));
  rule.needs_rest = true;
  EXPECT_FALSE(rule.is_over(2, false));
  EXPECT_TRUE(rule.is_over(2, true));
}

}  // namespace
}  // namespace plica
