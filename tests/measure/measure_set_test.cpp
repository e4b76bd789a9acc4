// Columns of results, and the sets that a scenario measures.
#include "measure/measure_set.hpp"

#include <gtest/gtest.h>

#include <set>

#include "core/errors.hpp"
#include "measure/cell_columns.hpp"
#include "measure/columns.hpp"
#include "measure/observation.hpp"
#include "record/series_rows.hpp"
#include "record/summary.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/small_furrow.hpp"

namespace plica {
namespace {

template <class Columns>
void expect_named_and_explained(const Columns& columns, std::size_t at_least) {
  std::set<std::string_view> names;
  for (const auto& column : columns) {
    EXPECT_TRUE(names.insert(column.name).second) << column.name << " twice";
    EXPECT_TRUE(column.meaning.ends_with('.')) << column.name;
    EXPECT_NE(measures_markdown().find("| `" + std::string(column.name) + "` |"), std::string::npos) << column.name;
  }
  EXPECT_GE(names.size(), at_least);
}

TEST(Columns, AreNamedOnceAndExplained) {
  expect_named_and_explained(columns(), 29);
  expect_named_and_explained(cell_columns(), 16);
  expect_named_and_explained(node_columns(), 3);
  expect_named_and_explained(midline_columns(), 5);
  expect_named_and_explained(section_columns(), 11);
  expect_named_and_explained(lineage_columns(), 4);
}

TEST(Columns, EachIsOfAStepOrOfTheRunAndGoesSomewhere) {
  for (const Column& column : columns()) {
    const bool of_run = column.in_summary == InSummary::whole_run;
    EXPECT_EQ(static_cast<bool>(column.of_run), of_run) << column.name;
    EXPECT_EQ(static_cast<bool>(column.of_step), !of_run) << column.name;
    EXPECT_TRUE(column.in_series || column.in_summary != InSummary::nothing) << column.name;
    EXPECT_FALSE(column.in_series && of_run) << column.name;
  }
  EXPECT_EQ(column_index("time_s"), 0U);
  EXPECT_THROW((void)column_index("no such column"), std::logic_error);
}

// Three rows, of which the last lacks two values.
std::vector<Observation> three_rows() {
  std::vector<Observation> rows(3);
  const auto put = [&](std::size_t row, std::string_view name, double value) {
    rows[row].values[column_index(name)] = value;
  };
  const double depths[] = {0, 5, 3}, errors[] = {1e-10, 3e-10, 2e-10}, jacobians[] = {0.9, 0.7, 0.8};
  for (std::size_t r = 0; r < 3; ++r) {
    put(r, "time_s", static_cast<double>(r));
    put(r, "furrow_depth_um", depths[r]);
    put(r, "max_volume_error", errors[r]);
    put(r, "min_scaled_jacobian", jacobians[r]);
  }
  put(1, "newton_iterations", 4), put(2, "newton_iterations", 3);
  put(1, "lip_distance_um", 50);
  put(1, "max_shell_penetration_um", 0.25);
  return rows;
}

TEST(Columns, TheSummaryHasWhatTheRowSays) {
  const std::vector<Observation> rows = three_rows();
  const auto value = [&](std::string_view name) {
    for (const auto& [column, found] : summary_values(all_columns(), rows))
      if (column->name == name) return found;
    ADD_FAILURE() << name;
    return std::optional<double>();
  };
  EXPECT_EQ(value("furrow_depth_um"), 3);
  EXPECT_EQ(value("max_volume_error"), 3e-10);
  EXPECT_EQ(value("min_scaled_jacobian"), 0.7);
  EXPECT_EQ(value("newton_iterations"), 7);
  EXPECT_EQ(value("max_shell_penetration_um"), 0.25) << "what has no value does not count";
  EXPECT_FALSE(value("lip_distance_um")) << "the last has none";
  EXPECT_FALSE(value("peak_speed_ratio"));
}

// Programs read these files: a column may be added, but none moved.
TEST(Columns, ThoseOfTheContractStayInTheirOrder) {
  std::string summary;
  for (const Column* column : summary_columns(all_columns())) summary += std::string(column->name) + ' ';
  EXPECT_TRUE(summary.starts_with(
      "furrow_depth_um furrow_depth_below_lips_um lip_distance_um highest_points_distance_um vml_apical_area_ratio "
      "vce_apical_area_ratio vml_displacement_um vce_displacement_um peak_speed_ratio peak_speed_ratio_time_s "
      "ends_lead_until_s vml_displacement_at_equal_speed_um vce_displacement_at_equal_speed_um max_node_speed_um_per_s "
      "max_volume_error max_shell_penetration_um min_scaled_jacobian lumen_volume_ratio newton_iterations "
      "linear_iterations "))
      << summary;
  EXPECT_EQ(names_of(lineage_columns()), (std::vector<std::string>{"cell_id", "mother_id", "generation", "birth_s"}));
}

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
