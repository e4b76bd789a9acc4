// Files of experiments, their quantities as formulas, and what is judged of them.
#include "core/files.hpp"
#include "experiments/experiments.hpp"
#include "experiments/formula.hpp"
#include "support/own_folder.hpp"
#include "support/scenarios.hpp"

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
    EXPECT_SAYS(error_of<std::invalid_argument>([&] { return Formula(text); }), problem) << text;
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

// A file of experiments, with a scenario and a table of draws beside it.
class ReadExperiments : public OwnFolder {
 protected:
  ReadExperiments() {
    write("block.toml", pulled_block().text);
    write("draws.csv", "contraction.all.stiffness_nN_per_um,time.end_s\n1,5\n2,5\n3,4\n");
  }
  [[nodiscard]] Experiments parsed(const std::string& text) const {
    return parse_experiments("mine", (folder / "mine.toml").string(), text);
  }
  // All that is wrong, without the folder; with lines of the file.
  [[nodiscard]] std::string complaint(const std::string& text) const {
    const std::string what = errors_in([&] { check_experiments(parsed(text)); });
    return std::regex_replace(std::regex_replace(what, std::regex(folder.string() + "/"), ""), std::regex("mine.toml:"),
                              "line ");
  }
};

const std::string good = R"(title = "Blocks"
scenario = "block.toml"
draws = "draws.csv"
[experiment.reference.outcome.end]
question = "How long is it?"
role = "fitted"
quantity = "end.position_um"
hit = [20, 30]
[experiment.stiff]
question = "Is it shorter when it pulls more?"
observed = "It is."
prediction = "hit"
set = { "contraction.all.across_ratio" = 0.5 }
draws = 2
slow = true
[experiment.stiff.outcome.end]
quantity = "end.position_um"
minus = "reference"
hit = [-inf, 0]
undecided = 0.5
[experiment.stiff.outcome.rest]
role = "seen"
question = "Does it come to rest?"
quantity = "equilibrium_time_s"
hit_if_none = true
)";

TEST_F(ReadExperiments, TakesWhatTheFileSays) {
  const Experiments experiments = parsed(good);
  EXPECT_EQ(experiments.title, "Blocks");
  ASSERT_EQ(experiments.experiments.size(), 2U);
  EXPECT_EQ(experiments.draws.runs.size(), 3U);
  const Experiment &reference = experiments.experiments[0], &stiff = experiments.experiments[1];
  EXPECT_EQ(reference.name, "reference");
  EXPECT_EQ(reference.draws, 3U);
  EXPECT_EQ(stiff.draws, 2U);
  EXPECT_TRUE(stiff.slow && !reference.slow);
  ASSERT_EQ(stiff.outcomes.size(), 2U);
  const Outcome &end = stiff.outcomes[0], &rest = stiff.outcomes[1];
  EXPECT_EQ(reference.outcomes[0].role, Role::fitted);
  EXPECT_EQ(end.role, Role::predicted);
  EXPECT_EQ(end.question, "Is it shorter when it pulls more?");
  EXPECT_EQ(end.observed, "It is.");
  EXPECT_EQ(end.prediction, Judgement::hit);
  EXPECT_FALSE(rest.prediction);
  EXPECT_EQ(end.comparing, Comparing::difference);
  EXPECT_EQ(end.compared_with, 0U);
  EXPECT_TRUE(std::isinf(end.low) && end.low < 0);
  EXPECT_EQ(end.high, 0);
  EXPECT_EQ(end.margin, 0.5);
  EXPECT_EQ(rest.role, Role::seen);
  EXPECT_EQ(rest.question, "Does it come to rest?");
  EXPECT_EQ(rest.observed, "");  // which belongs to another question
  EXPECT_TRUE(rest.hit_if_none && !rest.has_band());
  EXPECT_EQ(experiments.overrides(1, 1),
            (std::vector<std::string>{"contraction.all.stiffness_nN_per_um=2", "time.end_s=5",
                                      "contraction.all.across_ratio=0.5"}));
  EXPECT_EQ(experiments.scenario(0, 2).contractions.begin()->second.stiffness_nN_per_um, 3);
  check_experiments(experiments);
}

TEST_F(ReadExperiments, ChangeWhatADrawSets) {
  std::string text = good;
  text.replace(text.find("across_ratio\" = 0.5"), 19, "stiffness_nN_per_um\" = 9");
  for (std::size_t draw = 0; draw < 2; ++draw)
    EXPECT_EQ(parsed(text).scenario(1, draw).contractions.begin()->second.stiffness_nN_per_um, 9);
}

TEST_F(ReadExperiments, WithoutDrawsRunOnce) {
  std::string text = good;
  text.erase(text.find("draws = \"draws.csv\"\n"), 20);
  const Experiments experiments = parsed(text);
  EXPECT_EQ(experiments.draws.runs.size(), 1U);
  EXPECT_EQ(experiments.experiments[1].draws, 1U);
  EXPECT_TRUE(experiments.overrides(0, 0).empty());
  check_experiments(experiments);
}

TEST_F(ReadExperiments, RefuseWhatIsWrongWithLineKeyAndRemedy) {
  struct Case {
    std::string from, to;                // in `good`
    std::vector<std::string> complaint;  // has all of these
  };
  const std::vector<Case> cases = {
      {"title = \"Blocks\"", "titel = 1", {"line 1: titel: unknown key; use \"title\" (nearest match)"}},
      {"title = \"Blocks\"", "format = 2", {"line 1: format: is unknown to this version"}},
      {"draws = 2", "draw = 2", {"line 14: experiment.stiff.draw: unknown key; use \"draws\" (nearest match)"}},
      {"draws = 2",
       "draws = 2\ndrawn = false",
       {"line 14: experiment.stiff.draws: conflicts with drawn = false, which makes one run; remove it"}},
      {"draws = 2",
       "draws = 0",
       {"line 14: experiment.stiff.draws: 0 is out of range; set draws to a whole number from 1"}},
      {"slow = true", "slow = \"no\"", {"line 15: experiment.stiff.slow: is not true or false"}},
      {"\"block.toml\"", "\"blok.toml\"", {"line 2: scenario: ", "use \"block.toml\" (nearest match)"}},
      {"\"draws.csv\"", "\"drawn.csv\"", {"line 3: draws: ", "name a CSV file"}},
      {"role = \"fitted\"",
       "role = \"fited\"",
       {"line 6: ", "role: \"fited\" is unknown; use \"fitted\" (nearest match)"}},
      {"prediction = \"hit\"\n",
       "",
       {"experiment.stiff.outcome.end.prediction: is missing; give the result you predict before the run"}},
      {"prediction = \"hit\"", "prediction = \"yes\"", {"line 12: experiment.stiff.prediction: \"yes\" is unknown"}},
      {"question = \"How long is it?\"\n",
       "",
       {"experiment.reference.outcome.end.question: is missing; give it as a sentence"}},
      {"quantity = \"end.position_um\"\nhit", "hit", {"experiment.reference.outcome.end.quantity: is missing"}},
      {"hit = [20, 30]\n", "", {"line 4: experiment.reference.outcome.end.hit: is missing; give [from, to]"}},
      {"hit = [20, 30]", "hit = [30, 20]", {"line 8: ", "is an empty range; give the smaller number first"}},
      {"hit = [20, 30]", "hit = 20", {"line 8: ", "is not a pair of numbers"}},
      {"undecided = 0.5", "undecided = -1", {"line 20: ", "undecided: is negative; give 0 or more"}},
      {"undecided = 0.5", "undecided = inf", {"line 20: ", "undecided: is not a number"}},
      {"minus = \"reference\"",
       "minus = \"referense\"",
       {"line 18: ", "is not an experiment of this file; use \"reference\" (nearest match)"}},
      {"minus = \"reference\"", "minus = \"stiff\"", {"line 18: ", "is the experiment itself"}},
      {"undecided = 0.5", "over = \"reference\"", {"line 18: ", "minus: conflicts with over; remove one of the two"}},
      {"[experiment.stiff.outcome.rest]",
       "[experiment.\"st iff\".outcome.rest]",
       {"experiment.st iff: is not a valid name; use letters"}},
      {"[experiment.reference.outcome.end]\n",
       "[experiment.reference]\noutcome = 3\n",
       {"line 5: experiment.reference.outcome: is not a table"}},
      {"[experiment.reference.outcome.end]\n",
       "[experiment.reference.outcome]\n",
       {"experiment.reference.outcome.hit: is not a table; outcomes have names: write "
        "[experiment.reference.outcome.NAME]"}},
      {"[experiment.reference.outcome.end]\n",
       "[experiment.reference]\ndraws = 1\n[experiment.reference.outcome.end]\n",
       {"is compared with reference, which has 1 draws instead of 2; give reference as many draws"}},
      {"slow = true", "", {}},
      {"draws = 2\nslow = true", "", {}},
      {"[experiment.reference.outcome.end]\n",
       "[experiment.reference]\nslow = true\n[experiment.reference.outcome.end]\n",
       {}},
      {"quantity = \"end.position_um\"\nhit",
       "quantity = \"end.positon_um\"\nhit",
       {"line 4: experiment.reference.outcome.end.quantity: \"end.positon_um\" is not a number of summary.json; "
        "use \"end.position_um\" (nearest match)"}},
      {"quantity = \"end.position_um\"\nhit",
       "quantity = \"end.position_um@9 / end.position_um@\"\nhit",
       {"line 7: experiment.reference.outcome.end.quantity: is incomplete; write names of numbers"}},
      {"quantity = \"end.position_um\"\nhit",
       "quantity = \"end.positon_um@9\"\nhit",
       {"line 4: ", "\"end.positon_um\" is not a column of series.csv; use \"end.position_um\" (nearest match)"}},
      {"hit = [20, 30]",
       "hit = [20, 30]\nother_quantity = \"time_s\"",
       {"line 9: ", "other_quantity: applies only with over or minus; remove it"}},
      {"title = \"Blocks\"", "kind = \"claim\"", {"line 1: kind: \"claim\" is unknown; use \"claims\""}},
      {"across_ratio\" = 0.5",
       "acros_ratio\" = 0.5",
       {"line 13: experiment.stiff.set.contraction.all.acros_ratio: unknown key; use \"across_ratio\" (nearest "
        "match)"}},
      {"across_ratio\" = 0.5",
       "across_ratio\" = \"x\"",
       {"line 13: experiment.stiff.set.contraction.all.across_ratio: \"x\" has the wrong type; set across_ratio "
        "to a number"}},
      {"contraction.all.across_ratio",
       "contraction.al.across_ratio",
       {"line 13: experiment.stiff.set.contraction.al.across_ratio: the scenario has no contraction.al; use "
        "\"all\" (nearest match)"}},
      {"title = \"Blocks\"", "title = \"Blocks", {"line 1:"}},
  };
  int refused = 0;
  for (const Case& one : cases) {
    std::string text = good;
    const std::size_t at = text.find(one.from);
    ASSERT_NE(at, std::string::npos) << one.from;
    text.replace(at, one.from.size(), one.to);
    const std::string found = complaint(text);
    for (const std::string& part : one.complaint) EXPECT_SAYS(found, part);
    EXPECT_EQ(found.empty(), one.complaint.empty()) << one.to << "\n" << found;
    refused += one.complaint.empty() ? 0 : 1;
  }
  EXPECT_GE(refused, 25);
  EXPECT_SAYS(complaint("[experiment.a.outcome.\"../b\"]\n"), "experiment.a.outcome.../b: is not a valid name");
  EXPECT_SAYS(complaint("[experiment.a.outcome.b]\n"), "experiment.a.scenario: is missing");
  std::string slow = good;
  slow.erase(slow.find("slow = true\n"), 12);
  slow.insert(slow.find("[experiment.reference.outcome.end]"), "[experiment.reference]\nslow = true\n");
  EXPECT_SAYS(complaint(slow), "is compared with reference, which is slow");
  EXPECT_SAYS(complaint(""), " no experiments; write [experiment.NAME]");
  EXPECT_SAYS(complaint(pulled_block().text), "no experiments");
  EXPECT_SAYS(complaint("[experiment]\n"), "experiment: is empty");
  EXPECT_SAYS(complaint("[experiment.a]\nscenario = \"block.toml\"\n"), "experiment.a.outcome: is missing");
}

TEST_F(ReadExperiments, RefuseDrawsWithFileLineAndColumn) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "draws.csv: no points"},
      {"time.end_s\n", "draws.csv: no points"},
      {"time.end_s,contraction.all.stiffness_nN_per_um\n5,1\n5\n", "draws.csv:3: has 1 values; give 2"},
      {"time.ends\n5\n4\n", "draws.csv:1: column 1 (time.ends): unknown key"},
      {"time.end_s,contraction.all.stiffness_nN_per_um\n5,1\n5,soft\n",
       "draws.csv:3: column 2 (contraction.all.stiffness_nN_per_um): \"soft\" has the wrong type; set "
       "stiffness_nN_per_um to a number"},
      {"time.end_s\n5\n-4\n", "draws.csv:3: column 1 (time.end_s): "},
      {"contraction.al.stiffness_nN_per_um\n5\n",
       "draws.csv:2: contraction.al.stiffness_nN_per_um: the scenario has no contraction.al; use \"all\" (nearest "
       "match)"},
  };
  for (const auto& [draws, expected] : cases) {
    write_file(folder / "draws.csv", draws);
    EXPECT_SAYS(complaint(good), expected) << expected << "\n" << complaint(good);
  }
}

TEST_F(ReadExperiments, BuiltInOnesAreWhole) {
  for (const auto& [name, first] : {std::pair{"living", "reference"}, {"paper", "pill-fixed"}}) {
    const Experiments all = read_experiments(name);
    EXPECT_EQ(all.name, name);
    ASSERT_GE(all.experiments.size(), 2U);
    EXPECT_EQ(all.experiments[0].name, first);
    for (std::size_t e = 0; e < all.experiments.size(); ++e)
      for (std::size_t d = 0; d < all.experiments[e].draws; ++d) (void)all.scenario(e, d);
  }
  EXPECT_THROW((void)read_experiments("livign"), UsageError);
}

TEST_F(ReadExperiments, OfClaimsNeedNoPrediction) {
  std::string text = "kind = \"claims\"\n" + good;
  text.replace(text.find("prediction = \"hit\"\n"), 19, "");
  text.replace(text.find("[experiment.reference"), 0,
               "[quantity]\nreach = \"end.position_um@rest\"\nrest = \"time_s\"\n");
  text.replace(text.find("minus ="), 0, "other_quantity = \"reach\"\n");
  EXPECT_SAYS(complaint(text), "\"rest\" is not a number of summary.json");
  text.replace(text.find("@rest"), 5, "@5");
  const Experiments experiments = parsed(text);
  EXPECT_TRUE(experiments.are_of_claims);
  EXPECT_EQ(experiments.experiments[1].outcomes[0].role, Role::seen);
  EXPECT_FALSE(experiments.experiments[1].outcomes[0].formula.uses_series());
  EXPECT_TRUE(experiments.experiments[1].outcomes[0].other_formula.uses_series());
  check_experiments(experiments);
}

// What the draws set may have no meaning in a scenario of its own.
TEST_F(ReadExperiments, NotDrawnRunOnceAsTheirScenarioIs) {
  std::string text = good;
  text.replace(text.find("draws = 2"), 9, "drawn = false");
  const Experiments experiments = parsed(text);
  EXPECT_EQ(experiments.experiments[1].draws, 1U);
  EXPECT_EQ(experiments.overrides(1, 0), (std::vector<std::string>{"contraction.all.across_ratio=0.5"}));
  check_experiments(experiments);
}

}  // namespace
