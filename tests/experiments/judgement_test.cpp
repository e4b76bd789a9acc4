#include "experiments/judgement.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace plica {
namespace {

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
