// Quantities of experiments as formulas, and what is judged of them.
#include "experiments/judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "experiments/formula.hpp"

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

Outcome within(double low, double high, double margin = 0) {
  Outcome outcome;
  outcome.low = low, outcome.high = high, outcome.margin = margin;
  return outcome;
}

TEST(Judgement, IsAHitWithinUndecidedBesideAndElseAMiss) {
  const Outcome outcome = within(1, 2, 0.5);
  for (const double hit : {1.0, 1.5, 2.0}) EXPECT_EQ(judge(outcome, hit), Judgement::hit) << hit;
  for (const double near : {0.5, 0.99, 2.01, 2.5}) EXPECT_EQ(judge(outcome, near), Judgement::undecided) << near;
  for (const double far : {-7.0, 0.49, 2.51}) EXPECT_EQ(judge(outcome, far), Judgement::miss) << far;
  EXPECT_EQ(judge(within(1, 2), 2.0001), Judgement::miss);
  EXPECT_EQ(judge(within(-INFINITY, 2), -1e300), Judgement::hit);
}

TEST(Judgement, OfNoNumberIsAMissUnlessThatWasAskedFor) {
  Outcome outcome = within(1, 2, 0.5);
  EXPECT_EQ(judge(outcome, std::nullopt), Judgement::miss);
  outcome.hit_if_none = true;
  EXPECT_EQ(judge(outcome, std::nullopt), Judgement::hit);
  EXPECT_EQ(judge(outcome, 9), Judgement::miss);
  Outcome none;
  none.hit_if_none = true;
  EXPECT_FALSE(none.has_band());
  EXPECT_EQ(judge(none, std::nullopt), Judgement::hit);
  EXPECT_EQ(judge(none, 0), Judgement::miss);
}

TEST(Judgement, ComparesWithTheOtherExperiment) {
  Outcome outcome = within(0, 0.3);
  outcome.comparing = Comparing::ratio;
  EXPECT_EQ(compared(outcome, 6, 24), 0.25);
  EXPECT_EQ(judge(outcome, 6, 24), Judgement::hit);
  EXPECT_EQ(judge(outcome, 12, 24), Judgement::miss);
  EXPECT_EQ(compared(outcome, 6, 0), std::nullopt);
  EXPECT_EQ(judge(outcome, 6, 0), Judgement::undecided);
  EXPECT_EQ(judge(outcome, 6, std::nullopt), Judgement::undecided);  // nothing to compare it with
  EXPECT_EQ(judge(outcome, std::nullopt, 24), Judgement::miss);
  outcome.comparing = Comparing::difference;
  EXPECT_EQ(compared(outcome, 6, 24), -18);
  EXPECT_EQ(judge(outcome, 24.25, 24), Judgement::hit);
}

TEST(ProbabilityOfHit, IsThatOfTheBetaDistribution) {
  struct Case {
    std::size_t hits, draws;
    double low, high;
  };
  // Of Beta(1 + n, 1) the quantile q is q^(1 / (1 + n)); the others by SciPy 1.17, beta.ppf.
  for (const auto& [hits, draws, low, high] :
       {Case{0, 0, 0.05, 0.95}, Case{1, 1, std::sqrt(0.05), std::sqrt(0.95)},
        Case{10, 10, std::pow(0.05, 1.0 / 11), std::pow(0.95, 1.0 / 11)},
        Case{0, 4, 1 - std::pow(0.95, 0.2), 1 - std::pow(0.05, 0.2)}, Case{8, 10, 0.5299132, 0.92117995}}) {
    const Interval known = probability_of_hit(hits, draws);
    EXPECT_NEAR(known.low, low, 5e-8) << hits << " of " << draws;
    EXPECT_NEAR(known.high, high, 5e-8) << hits << " of " << draws;
  }
}

TEST(Tally, IsThatOfFourFifthsOfTheDraws) {
  const auto verdict = [](std::size_t hits, std::size_t misses, std::size_t undecided, std::size_t not_solved = 0) {
    std::vector<Judgement> draws;
    draws.insert(draws.end(), hits, Judgement::hit);
    draws.insert(draws.end(), misses, Judgement::miss);
    draws.insert(draws.end(), undecided, Judgement::undecided);
    draws.insert(draws.end(), not_solved, Judgement::not_solved);
    const Tally tally = tally_of(draws);
    EXPECT_EQ(tally.draws, hits + misses + undecided + not_solved);
    return tally.verdict();
  };
  EXPECT_EQ(verdict(8, 2, 0), Judgement::hit);
  EXPECT_EQ(verdict(7, 3, 0), Judgement::undecided);
  EXPECT_EQ(verdict(2, 8, 0), Judgement::miss);
  EXPECT_EQ(verdict(4, 1, 0), Judgement::hit);
  EXPECT_EQ(verdict(0, 5, 5), Judgement::undecided);  // no hit, and yet no miss
  EXPECT_EQ(verdict(0, 5, 0, 5), Judgement::undecided);
  EXPECT_EQ(verdict(7, 0, 0, 3), Judgement::undecided);
  EXPECT_EQ(verdict(0, 0, 0), Judgement::undecided);
}

TEST(VerdictOfClaim, FollowsFromTheFirstReadingAndTheOthers) {
  using enum ClaimVerdict;
  EXPECT_EQ(verdict_of_claim(Judgement::hit, true, Role::seen), reproduced);
  EXPECT_EQ(verdict_of_claim(Judgement::hit, false, Role::seen), under_this_reading);
  EXPECT_EQ(verdict_of_claim(Judgement::hit, true, Role::fitted), under_this_reading);
  EXPECT_EQ(verdict_of_claim(Judgement::miss, true, Role::seen), not_reproduced);
  EXPECT_EQ(verdict_of_claim(Judgement::undecided, false, Role::seen), not_reproduced);
  EXPECT_EQ(verdict_of_claim(Judgement::not_solved, false, Role::seen), not_solved);
}

}  // namespace
}  // namespace plica
