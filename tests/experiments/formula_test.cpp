#include "experiments/formula.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

namespace plica {
namespace {

// The middle is in 7-10 um from 7 s to 10 s, the ends in 13-17 um from 6.5 s to 8.5 s; no row lies in both.
const RunNumbers run = {{{"depth_um", 20.0}, {"rest_s", 10.0}, {"closed_s", nullptr}, {"fast.speed", 0.5}},
                        {{"time_s", "middle", "ends", "speed", "gap"},
                         {{0, 0, 0, 0, {}}, {5, 5, 10, 0.5, 1}, {15, 15, 30, 0.1, {}}, {20, 15, 30, 0.3, 2}}}};

void expect_value(const std::string& text, std::optional<double> expected) {
  const std::optional<double> value = Formula(text).value(run);
  ASSERT_EQ(value.has_value(), expected.has_value()) << text;
  EXPECT_NEAR(value.value_or(0), expected.value_or(0), 1e-12) << text;
}

TEST(Formula, CalculatesWithNumbersOfTheSummaryAndOfTheSeriesAtATime) {
  expect_value("depth_um", 20);
  expect_value("fast.speed", 0.5);
  expect_value("100 * (1 - depth_um / 25) + -2 - 1e-3", 17.999);
  expect_value("8 / 2 / 2 - 1 - 1", 0);
  expect_value("middle@10", 10);
  expect_value("middle@rest_s / ends@(rest_s + 2.5)", 10.0 / 25);
  expect_value("middle@900", 15);  // that at the end
  expect_value("max(1, 3, 2) - min(depth_um, 4)", -1);
}

TEST(Formula, HasNoValueWithoutOneOfItsParts) {
  for (const char* text : {"closed_s", "closed_s + 1", "gap@10", "middle@closed_s", "1 / (depth_um - 20)", "none@3"})
    expect_value(text, std::nullopt);
}

TEST(Formula, FindsTheFirstTimeBetweenRows) {
  expect_value("first(middle > middle@20 / 5)", 3);
  expect_value("first(middle > 7, middle < 10, ends > 13, ends < 17)", 7);
  expect_value("first(speed < 0.2)", 12.5);  // not in the reference state, which is at rest
  expect_value("first(speed > 0.6)", std::nullopt);
  expect_value("first(gap > 0)", std::nullopt);  // of values that follow each other
  expect_value("2 * first(ends > depth_um)", 20);
}

TEST(Formula, FindsExtremesOfTheRowsThatMeetConditions) {
  expect_value("largest(ends - middle)", 15);
  expect_value("least(ends / middle)", 2);
  expect_value("largest(speed, middle > 0.9 * largest(middle))", 0.3);
  expect_value("least(speed, middle > 99)", std::nullopt);
}

TEST(Formula, CorrelatesRanksAsSpearman) {
  expect_value("rank_correlation(1, 5, 9)", 1);
  expect_value("rank_correlation(9, 5, 1)", -1);
  expect_value("rank_correlation(1, 2, 2, 3)", 0.9486832980505138);  // scipy.stats.spearmanr
  expect_value("rank_correlation(2, 2, 2)", std::nullopt);
}

TEST(Formula, UsesNamedOnesAndSaysWhatItNeeds) {
  const std::map<std::string, Formula> named = {{"rest", Formula("rest_s")}, {"half", Formula("middle@20 / 2")}};
  const Formula formula("first(middle > half) - rest", named);
  EXPECT_NEAR(formula.value(run).value(), 7.5 - 10, 1e-12);
  using Uses = std::vector<std::pair<std::string, Formula::Source>>;
  EXPECT_EQ(formula.uses(), (Uses{{"middle", Formula::Source::either},
                                  {"middle", Formula::Source::series},
                                  {"rest_s", Formula::Source::summary}}));
  EXPECT_TRUE(formula.uses_series());
  EXPECT_FALSE(Formula("rest", named).uses_series());
}

TEST(Formula, RefusesWhatItDoesNotUnderstand) {
  for (const auto& [text, problem] : std::vector<std::pair<std::string, std::string>>{
           {"", "is incomplete"},
           {"1 +", "is incomplete"},
           {"(1", "is incomplete"},
           {"1 2", "has \"2\" where"},
           {"middle@", "is incomplete"},
           {"first(middle)", "has \")\" where"},
           {"1 > 2", "has \"> 2\" where"},
           {"mean(middle)", "\"mean\" is not a function; use max, min, first"},
           {std::string(1000, '('), "nested too deeply"}}) {
    try {
      (void)Formula(text);
      ADD_FAILURE() << text;
    } catch (const std::invalid_argument& error) {
      EXPECT_NE(std::string(error.what()).find(problem), std::string::npos) << text << ": " << error.what();
    }
  }
}

}  // namespace
}  // namespace plica
