// Measure sets: what fits a tissue is measured, what a scenario names is, and nothing else has a column.
#include "measure/measure_set.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "record/series_rows.hpp"
#include "record/summary.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/small_furrow.hpp"

namespace plica {
namespace {

const std::string sheet =
    "[embryo]\nshape = \"sheet\"\nlength_um = 40\nwidth_um = 40\ncell_count = 30\ncell_height_um = 10\n"
    "[region.middle]\ny_um = [-8, 8]\n[cortex.pull]\nregion = \"middle\"\ntension_mN_per_m = 0.3\n";
const std::string organoid =
    "[embryo]\nshape = \"sphere\"\ndiameter_um = 100\ncell_height_um = 15\ncells = [5, 5, 4]\naxes = [\"x\", \"y\", "
    "\"z\"]\n"
    "[vitelline]\nenabled = false\n[cortex.pull]\nregion = \"all\"\ntension_mN_per_m = 0.3\n";

Scenario scenario_of(const std::string& text) { return load_scenario({"test", "test.toml", "format = 1\n" + text}); }

std::vector<std::string> sets_of(const Simulation& simulation) {
  std::vector<std::string> names;
  for (const MeasureSet& set : measure_sets())
    if (std::ranges::count(simulation.observer().columns(), set.name, &Column::set) > 0) names.emplace_back(set.name);
  return names;
}

TEST(MeasureSets, ATissueMeasuresWhatFitsIt) {
  using Names = std::vector<std::string>;
  EXPECT_EQ(sets_of(Simulation(scenario_of(sheet))), (Names{"", "fold", "bending"}));
  EXPECT_EQ(sets_of(Simulation(scenario_of(organoid))), (Names{"", "lumen", "bending"}));
  EXPECT_EQ(
      sets_of(Simulation(scenario_of(support::small_furrow.substr(std::size("format = 1"))))),
      (Names{"", "fold", "furrow", "contact", "closing", "lumen", "shell", "perivitelline", "flanks", "bending"}));
  EXPECT_EQ(sets_of(Simulation(scenario_of(sheet + "[self_contact]\nsurface = \"apical\"\n"))),
            (Names{"", "fold", "contact", "bending"}));
}

TEST(MeasureSets, NoColumnIsEmpty) {
  for (const std::string& text : {sheet, organoid}) {
    const Scenario scenario = scenario_of(text);
    Simulation simulation(scenario);
    std::vector<Observation> rows = {simulation.measures()};
    for (int step = 0; step < 3 && simulation.step(); ++step) rows.push_back(simulation.measures());
    for (const Column* column : simulation.observer().columns())
      if (column->in_series) {
        EXPECT_TRUE(rows.back()[*column]) << column->name;
      }
    const std::vector<std::string> names = series_header(simulation.observer());
    EXPECT_TRUE(std::ranges::none_of(names, [](const std::string& name) { return name.starts_with("v"); }));
    for (const auto& [column, value] : summary_values(simulation.observer().columns(), rows))
      EXPECT_TRUE(value || column->name.ends_with("_time_s")) << column->name;
    EXPECT_EQ(make_summary(scenario, simulation, rows, {}).contains("vml_height_um"), false);
  }
}

TEST(MeasureSets, AreThoseThatAreNamed) {
  const auto named = [](const std::string& sets, const std::string& more = "") {
    return sets_of(Simulation(scenario_of(sheet + "[measure]\nsets = [" + sets + "]\n" + more)));
  };
  using Names = std::vector<std::string>;
  EXPECT_EQ(named(""), (Names{""}));
  EXPECT_EQ(named("\"bending\""), (Names{"", "bending"}));
  EXPECT_EQ(named("\"furrow\""), (Names{"", "fold", "furrow"}));
  EXPECT_EQ(named("\"automatic\", \"closing\"", "[self_contact]\nsurface = \"apical\"\n"),
            (Names{"", "fold", "contact", "closing", "bending"}));
}

TEST(MeasureSets, OneThatDoesNotFitIsAnErrorWithARemedy) {
  const auto refusal = [](const std::string& more) -> std::string {
    try {
      const Simulation simulation(scenario_of(sheet + more));
    } catch (const ScenarioError& error) {
      return error.what();
    }
    return "none";
  };
  EXPECT_NE(refusal("[measure]\nsets = [\"lumen\"]\n").find("measure.sets: \"lumen\" has nothing to measure"),
            std::string::npos);
  EXPECT_NE(refusal("[measure]\nsets = [\"furow\"]\n").find("automatic | fold | furrow"), std::string::npos);
  const std::string expectation = "[expect]\nlip_distance_um = { value = 3, within = 1 }\n";
  EXPECT_NE(refusal(expectation).find("expect.lip_distance_um: is not measured; add \"furrow\" to measure.sets"),
            std::string::npos);
  EXPECT_EQ(refusal(expectation + "[measure]\nsets = [\"automatic\", \"furrow\"]\n"), "none");
}

// A set that nobody chose computes nothing; what is left has the same values.
TEST(MeasureSets, OthersChangeNothing) {
  Simulation all(scenario_of(sheet + "[measure]\nsets = [\"automatic\", \"furrow\"]\n")), few(scenario_of(sheet));
  all.step(), few.step();
  for (const Column* column : few.observer().columns())
    EXPECT_EQ(all.measures()[*column], few.measures()[*column]) << column->name;
}

}  // namespace
}  // namespace plica
