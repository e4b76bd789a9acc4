// Scenarios that tests share, what is wrong with others, and the remedies that messages name.
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

/// Sheet of 36 cells, three of which shrink to a twentieth and leave, though its forces would leave them four or five
/// walls.
inline std::string sheet_that_cells_leave(const std::string& end_min) {
  return "format = 1\n" + sheet_table(21, 21, 8, 36) + R"(periodic = ["x", "y"]
[elasticity]
model = "neo-hookean"
young_modulus_Pa = 100
poisson_ratio = 0
corner_barrier_Pa = 30
relaxation_min = 1
[exchange]
below_um = 0.25
[region.dying]
ids = [3, 10, 24]
[extrusion.dying]
region = "dying"
apical_area_below_um2 = 3
[growth.dying]
region = "dying"
final_ratio = 0.05
in_plane = 1
program = { time_s = [0, 180], activity = [1, 1] }
[cortex.lateral]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.1
[time]
end_min = )" +
         end_min + R"(
tolerance_um = 0.2
max_step_s = 6
[stop]
at_equilibrium = false
)";
}

/// An egg of 300 cells.
inline const std::string egg =
    "format = 1\n[embryo]\nshape = \"egg\"\nlength_um = 250\ndiameter_um = 120\ncell_count = 300\ncell_height_um = "
    "20\n";

/// Six cells, pulled together on their apical edges. Monitors: all.volume_um3, and end.position_um and
/// side.position_um, how far the block's largest x and y are.
inline ScenarioSource pulled_block(const std::string& more = "") {
  return {"block", "block.toml", R"(format = 1
[embryo]
shape = "block"
length_um = 60
width_um = 40
cell_height_um = 40
cells = [3, 2, 1]
[contraction.all]
region = "all"
stiffness_nN_per_um = 1
[time]
end_s = 5
step_s = 0.5
[stop]
at_equilibrium = false
[monitor.all]
quantity = "volume"
over = "sum"
[monitor.end]
quantity = "position"
axis = "x"
face = "apical"
over = "max"
[monitor.side]
quantity = "position"
axis = "y"
face = "apical"
over = "max"
)" + more};
}

/// A small embryo whose belly is drawn in: seconds, with what a closing furrow has but the yolk.
inline const std::string small_furrow = R"(format = 1
[embryo]
length_um = 300
diameter_um = 160
cell_height_um = 30
cells = [12, 8, 8]
[region.belly]
face = "ventral"
cells_across = 4
[elasticity]
young_modulus_Pa = 5
poisson_ratio = 0
corner_barrier_Pa = 10
[vitelline]
gap_um = 0.5
[dynamics]
surface_drag_Pa_s_per_um = 4
[cortex.apical]
region = "belly"
tension_mN_per_m = 1
saturation_ratio = 0.16
program = { time_min = [0, 1], activity = [0, 1] }
profile = { shape = "gaussian", sigma_cells = 2, full_length_um = 200, fade_um = 40 }
[cortex.basal]
region = "all"
faces = "basal"
stiffness_mN_per_m = 0.3
relaxation_min = 15
[cortex.walls]
region = "all"
faces = "lateral"
stiffness_mN_per_m = 0.02
compression_ratio = 0.1
[self_contact]
surface = "both"
search_um = 20
[time]
end_min = 2
[stop]
at_equilibrium = false
)";

inline std::vector<std::string> parts_of(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  for (std::size_t begin = 0, end = 0; end != std::string_view::npos; begin = end + separator.size()) {
    end = text.find(separator, begin);
    parts.emplace_back(text.substr(begin, end == std::string_view::npos ? end : end - begin));
  }
  return parts;
}

/// One list of "key = value" for each alternative of "...; set KEY = VALUE and KEY = VALUE (EFFECT), or KEY = ...".
inline std::vector<std::vector<std::string>> named_remedies(const std::string& message) {
  std::vector<std::vector<std::string>> remedies;
  const std::string mark = "; set ";
  const std::size_t begin = message.rfind(mark);
  if (begin == std::string::npos) return remedies;
  for (const std::string& alternative : parts_of(std::string_view(message).substr(begin + mark.size()), ", or "))
    remedies.push_back(parts_of(alternative.substr(0, alternative.rfind(" (")), " and "));
  return remedies;
}

/// Sheet of 36 cells that exchange neighbours by polarity and noise; 3 min.
inline const std::string exchanging_sheet = R"([embryo]
shape = "sheet"
length_um = 36
width_um = 36
cell_count = 36
cell_height_um = 10
[elasticity]
model = "neo-hookean"
young_modulus_Pa = 100
poisson_ratio = 0
relaxation_min = 1
[exchange]
below_um = 0.5
[cortex.lateral]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.5
direction = { axis = "along", strongest = 1.6, weakest = 0.4 }
noise = { spread = 0.8, correlation_s = 60 }
[cortex.apical]
region = "all"
tension_mN_per_m = 0.42
[cortex.basal]
region = "all"
faces = "basal"
tension_mN_per_m = 0.42
[time]
end_min = 3
max_step_s = 10
[stop]
at_equilibrium = false
)";

}  // namespace plica::support
