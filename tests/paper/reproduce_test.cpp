// The tables of claims and readings, and what is made of figures: verdicts and scores.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "paper/claims.hpp"
#include "paper/mechanism.hpp"
#include "paper/readings.hpp"
#include "paper/runs.hpp"

namespace plica {
namespace {

TEST(Verdict, FollowsFromTheFigureTheToleranceAndTheReadings) {
  Claim claim{"3", "text", "2", "pill.x", 1, 3};
  const std::vector<std::optional<double>> all = {1.5, 2.5}, some = {1.5, 4}, missing = {1.5, std::nullopt};
  EXPECT_EQ(verdict(claim, 2, all), Verdict::reproduced);
  EXPECT_EQ(verdict(claim, 2, some), Verdict::under_this_reading);
  EXPECT_EQ(verdict(claim, 2, missing), Verdict::under_this_reading);
  EXPECT_EQ(verdict(claim, 3.01, all), Verdict::not_reproduced);
  EXPECT_EQ(verdict(claim, std::nullopt, all), Verdict::not_reproduced);
  claim.basis = Basis::fixed;
  EXPECT_EQ(verdict(claim, 2, some), Verdict::reproduced);
  claim.basis = Basis::calibrated;
  EXPECT_EQ(verdict(claim, 2, all), Verdict::under_this_reading);
}

TEST(Claims, AreWhole) {
  int cases = 0;
  for (const Claim& claim : claims()) {
    EXPECT_LE(claim.low, claim.high) << claim.text;
    EXPECT_NE(claim.figure.find('.'), std::string::npos) << claim.text;
    EXPECT_FALSE(claim.section.empty() || claim.text.empty() || claim.printed.empty()) << claim.figure;
    ++cases;
  }
  EXPECT_GE(cases, 50);
}

TEST(Score, IsNothingForThePrintedNumbersAndTheLargestMissForNoneOfThem) {
  Figures printed, empty = {{"pill.depth_um", 1e6}, {"sphere.depth_um", 1e6}};
  for (const PrintedNumber& number : printed_numbers()) printed[number.name] = number.centre;
  const auto best = score(readings().front(), printed), worst = score(readings().front(), empty);
  ASSERT_TRUE(best && worst);
  EXPECT_EQ(best->rms, 0);
  EXPECT_EQ(best->met, static_cast<int>(printed_numbers().size()));
  EXPECT_DOUBLE_EQ(worst->rms, largest_miss);
  EXPECT_EQ(worst->met, 0);
  EXPECT_FALSE(score(readings().front(), {{"pill.depth_um", 28.89}}));
  // One number at the edge of its tolerance.
  printed["pill.rest_min"] += 0.75;
  EXPECT_NEAR(score(readings().front(), printed)->rms, 1 / std::sqrt(static_cast<double>(printed_numbers().size())),
              1e-12);
}

TEST(Readings, HaveRunsOfTheirOwnOrOfAnother) {
  std::set<std::string> ids;
  for (const PaperReading& reading : readings()) EXPECT_TRUE(ids.insert(reading.id).second) << reading.id;
  for (const PaperReading& reading : readings())
    EXPECT_TRUE(reading.options.same_runs_as.empty() || ids.contains(reading.options.same_runs_as)) << reading.id;
  EXPECT_GE(ids.size(), 25u);
}

TEST(Plan, LeavesOutNothingThatThisBuildKnows) {
  const Plan plan = make_plan(false);
  std::set<std::string> ids;
  for (const BatchRun& run : plan.runs) {
    EXPECT_TRUE(ids.insert(run.id).second) << run.id;
    EXPECT_TRUE(run.scenario.expect.empty()) << run.id;
  }
  for (const char* id : {"main-pill", "main-sphere", "fine-space-pill", "division-without", "across-1-sphere"})
    EXPECT_TRUE(ids.contains(id)) << id;
  for (const auto& [id, why] : plan.skipped)
    EXPECT_TRUE(id.starts_with("paper-") || id == "division-twice") << id << ": " << why;
}

TEST(Mechanism, IsLaplacesLaw) {
  const Figures figures = mechanism().figures;
  EXPECT_NEAR(figures.at("laplace.pill_ratio_of_tension"), 2, 0.1);
  EXPECT_NEAR(figures.at("laplace.sphere_ratio"), 1, 0.05);
  EXPECT_NEAR(figures.at("laplace.axial_middle_over_end"), 0, 0.01);
}

}  // namespace
}  // namespace plica
