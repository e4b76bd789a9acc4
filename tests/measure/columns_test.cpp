// The tables of columns: every row is whole, names are used once, and each summary comes out as its row says.
#include "measure/columns.hpp"

#include <gtest/gtest.h>

#include <set>

#include "measure/cell_columns.hpp"
#include "measure/observation.hpp"

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
  std::string series, summary;
  for (const Column* column : all_columns())
    if (column->in_series) series += std::string(column->name) + ' ';
  EXPECT_TRUE(series.starts_with(
      "time_s furrow_depth_um furrow_depth_below_lips_um lip_distance_um vml_speed_um_per_s vce_speed_um_per_s "
      "speed_ratio vml_displacement_um vce_displacement_um vml_apical_area_ratio vce_apical_area_ratio "
      "max_node_speed_um_per_s max_volume_error lumen_volume_ratio cells step_s newton_iterations linear_iterations "))
      << series;
  for (const Column* column : summary_columns(all_columns())) summary += std::string(column->name) + ' ';
  EXPECT_TRUE(summary.starts_with(
      "furrow_depth_um furrow_depth_below_lips_um lip_distance_um highest_points_distance_um vml_apical_area_ratio "
      "vce_apical_area_ratio vml_displacement_um vce_displacement_um peak_speed_ratio peak_speed_ratio_time_s "
      "ends_lead_until_s vml_displacement_at_equal_speed_um vce_displacement_at_equal_speed_um max_node_speed_um_per_s "
      "max_volume_error max_shell_penetration_um min_scaled_jacobian lumen_volume_ratio newton_iterations "
      "linear_iterations "))
      << summary;
  EXPECT_EQ(names_of(midline_columns()),
            (std::vector<std::string>{"time_s", "ap_um", "depth_um", "normal_speed_um_per_s", "apical_area_ratio"}));
  EXPECT_EQ(names_of(lineage_columns()), (std::vector<std::string>{"cell_id", "mother_id", "generation", "birth_s"}));
  EXPECT_EQ(cells_csv_names(), (std::vector<std::string>{"time_s", "cell_id", "mother_id", "generation", "x_um", "y_um",
                                                         "z_um", "volume_um3", "apical_area_um2", "basal_area_um2",
                                                         "height_um", "apical_area_ratio", "speed_um_per_s",
                                                         "pressure_Pa", "activity", "self_intersecting"}));
}

}  // namespace
}  // namespace plica
