// Scenarios of a few lines, and what is wrong with them.
#pragma once

#include <fmt/format.h>

#include <regex>

#include "core/errors.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "support/testing.hpp"

namespace plica::support {

inline Scenario scenario_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return load_scenario({"test", "test.toml", text}, overrides);
}

/// The errors of a call, one line each; nothing where it succeeds.
template <class Call>
std::string errors_in(const Call& call) {
  try {
    (void)call();
    return "";
  } catch (const ScenarioError& error) {
    return error.what();
  }
}
inline constexpr auto load_errors = [](const std::string& text, const std::vector<std::string>& overrides = {}) {
  return errors_in([&] { return scenario_of(text, overrides); });
};
inline std::string model_errors(const std::string& text) {
  return errors_in([&] { return make_model(scenario_of(text)); });
}
inline std::string side_errors(const std::string& text) {
  return errors_in([&] {
    const Scenario scenario = scenario_of(text);
    return make_solved_side(scenario, *make_model(scenario));
  });
}

/// Scenarios and all that is wrong with each, as one of the functions above says, less the name of the file.
using WrongScenarios = std::vector<std::pair<std::string, std::string>>;

template <class ErrorsOf>
void expect_errors(const WrongScenarios& cases, const ErrorsOf& errors_of) {
  const std::regex file("(^|\n)test\\.toml:");
  for (const auto& [text, errors] : cases) EXPECT_EQ(std::regex_replace(errors_of(text), file, "$1"), errors) << text;
}

/// A table of 200 points on a spheroid of half axes 120, 60 and 60 um, and an array that numbers them.
inline std::string numbered_points(const std::string& array) {
  std::string table = "x_um,y_um,z_um," + array + "\n";
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1) / 200.0, r = std::sqrt(1 - z * z), turn = 2.4 * i;
    table += std::to_string(120 * z) + ',' + std::to_string(60 * r * std::sin(turn)) + ',' +
             std::to_string(60 * r * std::cos(turn)) + ',' + std::to_string(i) + '\n';
  }
  return table;
}

/// Tables [embryo] of a block of cells and of a sheet of polygons, in um; more of its keys may follow.
inline std::string block_table(double length, double width, double height, const std::string& cells) {
  return fmt::format("[embryo]\nshape = \"block\"\nlength_um = {}\nwidth_um = {}\ncell_height_um = {}\ncells = [{}]\n",
                     length, width, height, cells);
}
inline std::string sheet_table(double length, double width, double height, int cells) {
  return fmt::format(
      "[embryo]\nshape = \"sheet\"\nlength_um = {}\nwidth_um = {}\ncell_height_um = {}\ncell_count = {}\n", length,
      width, height, cells);
}

/// An egg of 300 cells.
inline const std::string egg =
    "format = 1\n[embryo]\nshape = \"egg\"\nlength_um = 250\ndiameter_um = 120\ncell_count = 300\ncell_height_um = "
    "20\n";

}  // namespace plica::support
