#include "study/design.hpp"

#include "core/errors.hpp"
#include "core/numbers.hpp"
#include "study/csv_fields.hpp"
#include "study/study.hpp"
#include "support/testing.hpp"

namespace {

const std::string young = "elasticity.young_modulus_Pa", ratio = "elasticity.poisson_ratio";

StudyInput input_of(const std::string& vary, const std::string& design, const std::string& more = "") {
  return parse_study(
      "test", "test.toml",
      "format = 1\nscenario = \"division-demo\"\n" + more + "\n[vary]\n" + vary + "\n[design]\n" + design);
}

std::vector<std::vector<double>> numbers(const StudyDesign& design) {
  std::vector<std::vector<double>> result;
  for (const StudyPoint& run : design.runs) {
    result.emplace_back();
    for (const std::string& value : run.values) result.back().push_back(number_in(value).value_or(NAN));
  }
  return result;
}

std::vector<std::vector<double>> numbers(const std::string& vary, const std::string& design) {
  return numbers(design_of(input_of(vary, design)));
}

using Rows = std::vector<std::vector<double>>;

TEST(Design, GridTakesEveryValueWithEveryOther) {
  EXPECT_EQ(
      numbers("\"" + young + "\" = { low = 400, high = 800, count = 3 }\n\"" + ratio + "\" = { values = [0.3, 0.4] }",
              "kind = \"grid\""),
      (Rows{{400, 0.3}, {400, 0.4}, {600, 0.3}, {600, 0.4}, {800, 0.3}, {800, 0.4}}));
  EXPECT_EQ(numbers("\"" + young + "\" = { low = 1, high = 100, count = 3, scale = \"log\" }", "kind = \"grid\""),
            (Rows{{1}, {10}, {100}}));
  EXPECT_EQ(numbers("\"" + young + "\" = { low = 3, high = 8, step = 2 }", "kind = \"grid\""), (Rows{{3}, {5}, {7}}));
}

TEST(Design, WholeStepsAreWrittenAsWholeNumbers) {
  const StudyDesign design =
      design_of(input_of("\"embryo.cells\" = { values = [[4, 4, 1], [6, 6, 1]] }\n\"output.frame_every_s\" = { low = "
                         "10, high = 30, step = 10 }",
                         "kind = \"grid\""));
  EXPECT_EQ(design.runs[0].values, (std::vector<std::string>{"[4, 4, 1]", "10"}));
  EXPECT_EQ(design.runs[5].values, (std::vector<std::string>{"[6, 6, 1]", "30"}));
}

TEST(Design, KeysOfWholeNumbersTakeThemFromARange) {
  const StudyDesign design =
      design_of(input_of("\"region.furrow.cells_across\" = { low = 8, high = 14, count = 4 }", "kind = \"grid\""));
  std::vector<std::string> values;
  for (const StudyPoint& run : design.runs) values.push_back(run.values[0]);
  EXPECT_EQ(values, (std::vector<std::string>{"8", "10", "12", "14"}));
}

TEST(Design, ListTakesValuesSideBySide) {
  EXPECT_EQ(numbers("\"" + young + "\" = { values = [1, 2] }\n\"" + ratio + "\" = { values = [0.3, 0.4] }",
                    "kind = \"list\""),
            (Rows{{1, 0.3}, {2, 0.4}}));
}

TEST(Design, OneAtATimeKeepsTheOthersAsInTheScenario) {
  const auto rows = numbers("\"" + young + "\" = { values = [1, 2] }\n\"" + ratio + "\" = { values = [0.3] }",
                            "kind = \"one-at-a-time\"");
  ASSERT_EQ(rows.size(), 4u);
  EXPECT_EQ(rows[1], (std::vector<double>{1, rows[0][1]}));
  EXPECT_EQ(rows[3], (std::vector<double>{rows[0][0], 0.3}));
}

TEST(Design, LatinHypercubeHasOnePointInEverySlice) {
  const auto rows =
      numbers("\"" + young + "\" = { low = 100, high = 200 }\n\"" + ratio + "\" = { low = 0, high = 0.4 }",
              "kind = \"latin-hypercube\"\npoints = 50\nseed = 7");
  std::set<int> first, second;
  for (const auto& row : rows)
    first.insert(static_cast<int>((row[0] - 100) / 2)), second.insert(static_cast<int>(row[1] / 0.008));
  EXPECT_EQ(first.size(), 50u);
  EXPECT_EQ(second.size(), 50u);
}

// Of 64 points of a digital net in two dimensions, every box of an area of 1/64 whose sides are powers of 2 has one.
TEST(Design, SobolIsEvenlySpreadForEverySeed) {
  const std::string two = "\"" + young + "\" = { low = 1, high = 2 }\n\"" + ratio + "\" = { low = 0, high = 0.25 }";
  std::set<std::vector<double>> first_points;
  for (int seed = 0; seed < 5; ++seed) {
    const auto rows = numbers(two, "kind = \"sobol\"\npoints = 64\nseed = " + std::to_string(seed));
    for (int along = 1; along <= 64; along *= 2) {
      std::set<std::pair<int, int>> boxes;
      for (const auto& row : rows)
        boxes.emplace(static_cast<int>((row[0] - 1) * along), static_cast<int>(row[1] * 4 * 64 / along));
      EXPECT_EQ(boxes.size(), 64u) << "seed " << seed << ", " << along;
    }
    first_points.insert(rows.front());
  }
  EXPECT_EQ(first_points.size(), 5u);
}

// Saltelli's: each block has A, A with one coordinate of B, and B.
TEST(Design, SobolIndicesChangeOneKeyAtATime) {
  const auto rows = numbers("\"" + young + "\" = { low = 1, high = 2 }\n\"" + ratio + "\" = { low = 0, high = 0.4 }",
                            "kind = \"sobol-indices\"\npoints = 8");
  ASSERT_EQ(rows.size(), 8u * 4);
  for (std::size_t block = 0; block < rows.size(); block += 4) {
    const auto &a = rows[block], &b = rows[block + 3];
    EXPECT_EQ(rows[block + 1], (std::vector<double>{b[0], a[1]}));
    EXPECT_EQ(rows[block + 2], (std::vector<double>{a[0], b[1]}));
  }
}

TEST(Design, NormalDistributionsHaveTheirMeanAndAreCutOff) {
  const auto rows = numbers("\"" + young + "\" = { mean = 500, sd = 50 }\n\"" + ratio +
                                "\" = { mean = 0.3, sd = 0.2, low = 0.1, high = 0.45 }",
                            "kind = \"sobol\"\npoints = 4096");
  double sum = 0, squares = 0;
  for (const auto& row : rows) {
    sum += row[0], squares += (row[0] - 500) * (row[0] - 500);
    EXPECT_GE(row[1], 0.1);
    EXPECT_LE(row[1], 0.45);
  }
  EXPECT_NEAR(sum / 4096, 500, 0.1);
  EXPECT_NEAR(std::sqrt(squares / 4096), 50, 0.1);
}

TEST(Design, ReplicatesHaveSeedsOfTheirOwn) {
  const StudyInput input =
      parse_study("test", "test.toml",
                  "scenario = \"drosophila\"\n[set]\n\"contraction.apical.variation.spread\" = 0.3\n[vary]\n\"" +
                      young + "\" = { values = [900, 1000] }\n[design]\nkind = \"grid\"\nreplicates = 3\n");
  const StudyDesign design = design_of(input);
  ASSERT_EQ(design.runs.size(), 6u);
  EXPECT_EQ(design.runs[4].point, 2);
  EXPECT_EQ(design.runs[4].replicate, 2);
  EXPECT_EQ(design.runs[4].seeds, std::vector<std::string>{"contraction.apical.variation.seed=2"});
  EXPECT_EQ(load_scenario(input.scenario, overrides_of(input, design, design.runs[4]))
                .contractions.at("apical")
                .variation.seed,
            2);
  // As a file and back.
  const StudyDesign again = points_of_csv(points_csv(design));
  EXPECT_EQ(points_csv(again), points_csv(design));
  EXPECT_EQ(again.runs[5].seeds, design.runs[5].seeds);
}

TEST(CsvFields, ReadWhatTheyWrite) {
  const std::vector<std::string> fields = {"a", "", "1,5", "say \"no\"", "two\nlines", "[1, 2]"};
  std::string line;
  for (const std::string& field : fields) line += (line.empty() ? "" : ",") + csv_field(field);
  for (const std::string mark : {"", "\xef\xbb\xbf"})
    EXPECT_EQ(csv_fields(mark + line + "\n\nx,y\r\n"), (std::vector<std::vector<std::string>>{fields, {"x", "y"}}));
}

// The messages of a study that is none.
std::string refusal(const std::string& text) {
  return error_of<ScenarioError>([&] { const Study study(parse_study("test", "test.toml", text)); });
}

TEST(StudyInput, WhatMayNotBeMeantIsNoted) {
  const auto notes = [](const std::string& scenario, const std::string& vary, const std::string& design) {
    const Study study(
        parse_study("test", "test.toml", "scenario = \"" + scenario + "\"\n[vary]\n" + vary + "\n[design]\n" + design));
    std::string text;
    for (const Diagnostic& note : study.notes()) text += note.text() + '\n';
    return text;
  };
  EXPECT_EQ(notes("division-demo", "\"" + young + "\" = { low = 300, high = 900, step = 200 }", "kind = \"grid\""), "");
  EXPECT_EQ(notes("division-demo", "\"" + young + "\" = { low = 300, high = 800, step = 200 }", "kind = \"grid\""),
            "test.toml:3: vary." + young + ".step: does not reach high = 800; the last value is 700\n");
  const std::string spread = notes("drosophila", "\"contraction.apical.variation.spread\" = { values = [0, 0.3] }",
                                   "kind = \"grid\"\nreplicates = 3");
  EXPECT_SAYS(spread, "1 of 2 points have a spread of 0, so their 3 replicates are identical");
}

// sigma_um takes the place of the sigma_cells that the scenario has, as end_min does of end_s.
TEST(StudyInput, AKeyThatStandsInForAnotherMayVary) {
  const Study study(parse_study("test", "test.toml",
                                "scenario = \"drosophila-living\"\n[vary]\n\"cortex.apical.profile.sigma_um\" = { "
                                "values = [20, 30] }\n[design]\nkind = \"grid\"\n"));
  const ProfileInput profile = study.scenario_of(1).cortices.at("apical").profile;
  EXPECT_EQ(profile.sigma_um, 30);
  EXPECT_FALSE(profile.sigma_cells);
}

TEST(StudyInput, WhatIsNoStudySaysWhere) {
  const std::string head = "scenario = \"division-demo\"\n", vary = "[vary]\n\"" + young + "\" = ";
  const std::string good = "{ values = [400, 500] }\n", grid = "[design]\nkind = \"grid\"\n";
  EXPECT_EQ(refusal(head + vary + good + grid), "");
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[", "test.toml:1"},
      {vary + good + grid, "scenario: is missing"},
      {"scenario = \"nowhere\"\n" + vary + good + grid, "test.toml:1: scenario"},
      {"scenario = 3\n" + vary + good + grid, "is not a text"},
      {"format = 2\n" + head + vary + good + grid, "format = 1"},
      {head + vary + good, "design: is missing"},
      {head + "design = 3\n" + vary + good, "is not a table"},
      {head + vary + good + "[design]\n", "design.kind: is missing"},
      {head + vary + good + "[design]\nkind = \"gird\"\n", "use \"grid\" (nearest match)"},
      {head + vary + good + grid + "point = 3\n", "use \"points\" (nearest match)"},
      {head + vary + good + grid + "points = 3\n", "unused: the keys determine"},
      {head + vary + good + grid + "seed = 3\n", "nothing is sampled"},
      {head + vary + good + grid + "replicates = 0\n", "0 is out of range"},
      {head + vary + good + grid + "replicates = 2\n", "nothing is random"},
      {head + vary + good + grid + "file = \"a.csv\"\n", "unused by this kind"},
      {head + vary + good + "[design]\nkind = \"sobol\"\n", "number of points"},
      {head + vary + good + "[design]\nkind = \"sobol\"\npoints = 1.5\n", "is not a whole number"},
      {head + vary + good + "[design]\nkind = \"sobol\"\npoints = 3\nseed = -1\n", "is negative"},
      {head + vary + good + "[design]\nkind = \"file\"\nfile = \"a.csv\"\n", "the file has the values"},
      {head + "[design]\nkind = \"file\"\n", "design.file: is missing"},
      {head + grid, "vary: is empty"},
      {head + vary + "3\n" + grid, "no range or values"},
      {head + vary + "{ values = [] }\n" + grid, "values: is empty"},
      {head + vary + "{ values = 3 }\n" + grid, "is not a list"},
      {head + vary + "{ low = 1, high = 2, count = 1 }\n" + grid, "count: is 1, a single value"},
      {head + vary + "{ values = [1], low = 2 }\n" + grid, "mixes values with other keys"},
      {head + vary + "{ low = 1 }\n" + grid, "no bounds"},
      {head + vary + "{ low = 2, high = 1 }\n" + grid, "empty range"},
      {head + vary + "{ low = 1, high = 1 }\n" + grid, "put a single value into [set]"},
      {head + vary + "{ low = 1, high = inf, count = 3 }\n" + grid, "is not a number"},
      {head + vary + "{ low = 1, high = 2 }\n" + grid, "no values; give values, or low and high"},
      {head + vary + "{ low = 1, high = 2, step = 3 }\n" + grid, "not between 0 and high - low"},
      {head + vary + "{ low = 1, high = 2, step = 1, count = 2 }\n" + grid, "conflicts: step with"},
      {head + vary + "{ low = 0, high = 2, count = 3, scale = \"log\" }\n" + grid, "logarithmic scale with low <= 0"},
      {head + vary + "{ low = 1, high = 2, count = 3, scale = \"cubic\" }\n" + grid, "give linear or log"},
      {head + vary + "{ mean = 1 }\n[design]\nkind = \"sobol\"\npoints = 2\n", "incomplete normal distribution"},
      {head + vary + "{ mean = 1, sd = 1, count = 2 }\n" + grid, "mixes a normal distribution"},
      {head + vary + "{ low = 1, hihg = 2 }\n" + grid, "use \"high\" (nearest match)"},
      {head + vary + "{ low = 1, high = 2 }\n[design]\nkind = \"list\"\n", "no values"},
      {head + vary + good + "\"" + ratio + "\" = { values = [0.3] }\n[design]\nkind = \"list\"\n",
       "equally many for every key"},
      {head + "[set]\n\"" + young + "\" = 3\n" + vary + good + grid, "conflicts with [set]"},
      {head + "replicates = 2\n" + vary + good + grid, "test.toml:2: replicates: unknown key; it belongs in [design]"},
      {head + vary + good + vary.substr(7) + good + grid,
       "test.toml:4: \"" + young + "\": is set twice (first in line 3)"},
      {head + vary + good + "[design]\nkind = grid\n",
       "test.toml:5: kind: grid is not a valid value; put text in quotes: kind = \"grid\""},
      {"embryo.cells = [4, 4, 1]\n",
       "test.toml: is a scenario, not a study; run it with plica run test.toml --out DIR"},
      {head + vary + "{ values = [\"5 Pa\", 500] }\n" + grid,
       "test.toml:3: vary." + young + ": \"5 Pa\" has the wrong type; set young_modulus_Pa to a number > 0"},
      {head + vary + "{ values = [-5, 500] }\n" + grid, "test.toml:3: vary." + young + ": -5 is out of range"},
      {head + vary + "{ low = -5, high = 500 }\n[design]\nkind = \"sobol\"\npoints = 2\n",
       "test.toml:3: vary." + young + ": -5 is out of range"},
      {"scenario = \"drosophila\"\n[vary]\n\"contraction.apical.region\" = { values = [\"furow\", \"furrow\"] }\n" +
           grid,
       "test.toml:3: vary.contraction.apical.region: region \"furow\" does not exist; use \"furrow\" (nearest match)"},
      {"scenario = \"drosophila\"\n[vary]\n\"contraction.apicl.stiffness_nN_per_um\" = { values = [3] }\n" + grid,
       "test.toml:3: vary.contraction.apicl.stiffness_nN_per_um: the scenario has no contraction.apicl; use \"apical\" "
       "(nearest match)"},
      {"scenario = \"drosophila\"\n[set]\n\"contraction.apicl.stiffness_nN_per_um\" = 3\n" + vary + good + grid,
       "test.toml:3: set.contraction.apicl.stiffness_nN_per_um: the scenario has no contraction.apicl"},
      {"scenario = \"drosophila\"\n[vary]\n\"region.furrow.cells_across\" = { low = 8, high = 13, count = 4 }\n" + grid,
       "9.666666666666666 is not an integer"},
      {"scenario = \"drosophila-living\"\n[vary]\n\"cortex.apical.profile.half_width_um\" = { values = [3] }\n" + grid,
       "test.toml:3: vary.cortex.apical.profile.half_width_um: is not used with shape \"gaussian\""},
      {"scenario = \"drosophila-living\"\n[vary]\n\"cortex.apical.trigger.above\" = { values = [1] }\n" + grid,
       "test.toml:3: vary.cortex.apical.trigger.above: then cortex.apical.trigger.measure is missing"},
      {head + "[varry]\n\"" + young + "\" = " + good + grid,
       "test.toml:2: varry: unknown table; use \"vary\" (nearest match)"},
      {head + vary + good + grid + "[keep]\nmeasures = 3\n", "is not a list of names"},
      {head + vary + good + grid + "[keep]\nmeasures = [\"max_volume_eror\"]\n",
       "use \"max_volume_error\" (nearest match)"},
      {head + vary + good + grid + "[keep]\neach = \"rows\"\n", "use \"row\" (nearest match)"},
      {head + "[vary]\n\"elasticity.young_modulus\" = " + good + grid, "vary.elasticity.young_modulus"},
      {head + "[vary]\n\"embryo.cells\" = " + good + grid, "test.toml:3: vary.embryo.cells"},
      {head + vary + "{ values = [-1, -2] }\n" + grid, "test.toml:3: vary." + young},
      {head + vary + "{ low = 1, high = 2, count = 9999999 }\n\"" + ratio +
           "\" = { low = 0, high = 0.3, count = 9 }\n" + grid,
       "runs"},
  };
  for (const auto& [text, told] : cases) EXPECT_SAYS(refusal(text), told) << text << "\n-> " << refusal(text);
}

}  // namespace
