// Regions and profiles by arrays, rows, rings, angles and tables; pulses; messages.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "core/files.hpp"
#include "scenario/acting.hpp"
#include "scenario/advice.hpp"
#include "scenario/load.hpp"
#include "scenario/print.hpp"
#include "scenario/setup.hpp"
#include "simulation/controls.hpp"
#include "tissue/rows.hpp"

namespace plica {
namespace {

const std::string egg =
    "format = 1\n[embryo]\nshape = \"egg\"\nlength_um = 250\ndiameter_um = 120\ncell_count = 300\ncell_height_um = "
    "20\n";

std::string errors_of(const std::string& text) {
  try {
    make_model(load_scenario({"test", "test.toml", text}));
    return "";
  } catch (const ScenarioError& error) {
    return error.what();
  }
}

TEST(PatternKeys, RegionsByRowsAndNeighbours) {
  const Tissue tissue = make_tissue(load_scenario(
      {"test", "test.toml",
       egg + "[region.mesoderm]\nrows = 5\nlength_percent = [20, 80]\n[region.mesectoderm]\nneighbours_of = "
             "\"mesoderm\"\n[region.side]\nneighbours_of = \"mesoderm\"\nrings = 3\nexcept = [\"mesectoderm\"]\n"
             "[region.right]\nneighbours_of = \"mesoderm\"\ny_um = [0, 100]\n"}));
  const std::vector<int> halves = half_cells_from_midline(tissue);
  const CellSet &mesoderm = tissue.regions.at("mesoderm"), &beside = tissue.regions.at("mesectoderm"),
                &side = tissue.regions.at("side"), &right = tissue.regions.at("right");
  const CellSet around = cells_around(tissue, mesoderm, 1), far = cells_around(tissue, mesoderm, 3);
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Vec3 centre = cell_centre(tissue.cells[c], tissue.rest_positions);
    const bool is_long = centre.x() >= -75 && centre.x() <= 75;
    if (std::abs(std::abs(centre.x()) - 75) > 1) {
      EXPECT_EQ(mesoderm[c], halves[c] < 5 && is_long) << c;
    }
    EXPECT_EQ(beside[c], around[c]);
    EXPECT_EQ(side[c], far[c] && !around[c]);
    EXPECT_EQ(right[c], around[c] && centre.y() >= 0);
  }
  EXPECT_GT(std::ranges::count(side, true), std::ranges::count(beside, true));
}

TEST(PatternKeys, ProfilesOfAScenario) {
  const Scenario scenario = load_scenario(
      {"test", "test.toml",
       egg + "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1\nprofile = { shape = \"gaussian\", axis = "
             "\"angle\", sigma_deg = 20 }\n[cortex.b]\nregion = \"all\"\ntension_mN_per_m = 1\nprofile = { shape = "
             "\"table\", axis = \"angle\", at_deg = [-90, 0, 90], factor = [0, 1, 0.5] }\npulse = { period_min = 1.5, "
             "amplitude = 0.5, seed = 7 }\n[pressure.c]\nregion = \"all\"\npressure_Pa = 10\nprofile = { shape = "
             "\"table\", axis = \"along\", at_um = [0, 100], factor = [1, 0.2] }\n[elasticity.d]\nregion = "
             "\"all\"\nprofile = { shape = \"linear\", axis = \"along\", half_width_um = 100, edge = 0.5 }\n"});
  const Tissue tissue = make_tissue(scenario);
  const CellPattern a = make_pattern(scenario.contractions.at("a"), tissue),
                    b = make_pattern(scenario.cortices.at("b"), tissue),
                    c = make_pattern(scenario.pressures.at("c"), tissue),
                    d = make_pattern(scenario.region_elasticities.at("d"), tissue);
  for (std::size_t k = 0; k < tissue.cells.size(); ++k) {
    const Vec3 x = cell_centre(tissue.cells[k], tissue.rest_positions);
    const double angle = std::atan2(x.y(), -x.z()) * 180 / M_PI;
    EXPECT_NEAR(a.strengths[k], std::exp(-angle * angle / 800), 1e-9);
    const double table = angle < -90 ? 0 : angle < 0 ? 1 + angle / 90 : angle < 90 ? 1 - angle / 180 : 0.5;
    EXPECT_NEAR(b.strengths[k], table, 1e-9);
    // The middle lies between the outermost centres, near x = 0.
    EXPECT_NEAR(c.strengths[k], 1 - 0.8 * std::min(1.0, std::abs(x.x()) / 100), 0.03);
    EXPECT_NEAR(d.strengths[k], 1 - 0.5 * std::min(1.0, std::abs(x.x()) / 100), 0.03);
    EXPECT_EQ(b.pulse_periods_s[k], 90);
  }
  EXPECT_EQ(make_controls(scenario).max_step_s, 7.5);
  EXPECT_GE(make_controls(scenario).program_points_s.back(), scenario.time.end_s);
  // The printed scenario reads back as the same.
  const std::string printed = resolved_toml(scenario);
  EXPECT_EQ(resolved_toml(load_scenario({"test", "test.toml", printed})), printed);
}

TEST(PatternKeys, ProfilesByAnArray) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("plica_arrays_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::string table = "x_um,y_um,z_um,twi\n";
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1) / 200.0, r = std::sqrt(1 - z * z), turn = 2.4 * i;
    table += std::to_string(120 * z) + ',' + std::to_string(60 * r * std::sin(turn)) + ',' +
             std::to_string(60 * r * std::cos(turn)) + ',' + std::to_string(i) + '\n';
  }
  write_file(folder / "points.csv", table);
  const std::string points = "format = 1\n[embryo]\nshape = \"points\"\nfile = \"points.csv\"\ncell_height_um = 15\n";
  const std::string act = "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1\nprofile = ";
  const auto load = [&](const std::string& profile) {
    return load_scenario({"test", (folder / "test.toml").string(), points + act + profile + "\n"});
  };
  const Scenario scenario = load("{ shape = \"array\", array = \"twi\", from = 20, to = 120, middle = 2 }");
  const auto model = make_model(scenario);
  const CellPattern found = make_pattern(scenario.contractions.at("a"), model->tissue);
  for (int c = 0; c < 200; ++c) EXPECT_NEAR(found.strengths[c], 2 * std::clamp((c - 20) / 100.0, 0.0, 1.0), 1e-12);
  const auto lines_of = [&](const std::string& profile) {
    const Scenario other = load(profile);
    return advice(other, *make_model(other));
  };
  const std::string nothing =
      "warning: contraction.a: profile is 0 in every cell of region all (twi ranges from 0 to 199 there); change "
      "profile";
  EXPECT_EQ(std::ranges::count(lines_of("{ shape = \"array\", array = \"twi\", from = 300, to = 400 }"), nothing), 1);
  EXPECT_EQ(std::ranges::count(lines_of("{ shape = \"array\", array = \"twi\", from = 100, to = 400 }"), nothing), 0);
  try {
    make_model(load("{ shape = \"array\", array = \"sna\", from = 0, to = 1 }"));
    FAIL();
  } catch (const ScenarioError& error) {
    EXPECT_NE(
        std::string(error.what())
            .find(
                "test.toml:9: contraction.a.profile.array: the embryo has no array \"sna\"; set array to one of: twi"),
        std::string::npos)
        << error.what();
  }
  std::filesystem::remove_all(folder);
}

// Messages contain line, key and remedy.
TEST(PatternKeys, WhatIsWrongIsSaidWithItsKey) {
  int checked = 0;
  const auto expect = [&](const std::string& text, const std::string& said) {
    EXPECT_NE(errors_of(egg + text).find(said), std::string::npos) << errors_of(egg + text);
    ++checked;
  };
  const auto act = [](const std::string& more) {
    return "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1\n" + more + "\n";
  };
  expect("[region.r]\nneighbours_of = \"belly\"\n",
         "test.toml:9: region.r.neighbours_of: region \"belly\" does not exist");
  expect("[region.r]\nneighbours_of = \"r\"\n", "region.r: refers to itself: r > r; remove one of these references");
  expect("[region.a]\nneighbours_of = \"b\"\n[region.b]\nunion = [\"a\"]\n", "region.a: refers to itself: a > b > a");
  expect("[region.r]\nneighbours_of = \"all\"\n", "region.r: contains no cell of the embryo");
  expect("[region.r]\nrows = 3\nrings = 2\n",
         "test.toml:10: region.r.rings: is not used without neighbours_of; set neighbours_of to the region");
  expect("[region.r]\nrows = 0\n",
         "test.toml:9: region.r.rows: 0 is out of range; set rows to an integer, 1 to 100000");
  expect("[region.r]\nrows = 2.5\n", "region.r.rows: 2.5 is not an integer");
  expect("[region.r]\nneighbours_of = [\"a\"]\n",
         "region.r.neighbours_of: a list has the wrong type; set neighbours_of to a text");
  expect(act("profile = { shape = \"array\", from = 0, to = 1 }"),
         "test.toml:11: contraction.a.profile.array: is missing; set array to a cell array");
  expect(act("profile = { shape = \"array\", array = \"twi\", from = 0, to = 1 }"),
         "contraction.a.profile.array: the embryo has no array \"twi\"; set embryo.cell_arrays to a table");
  expect(act("profile = { shape = \"array\", array = \"twi\", to = 1 }"),
         "contraction.a.profile.from: is missing; set `from`");
  expect(act("profile = { shape = \"array\", array = \"twi\", from = 1, to = 1 }"),
         "contraction.a.profile.to: equals `from`; set `to` to a different value");
  expect(act("profile = { shape = \"gaussian\", sigma_um = 9, array = \"twi\" }"),
         "contraction.a.profile.array: is not used with shape \"gaussian\"; remove array, or set shape to \"array\"");
  expect(act("profile = { shape = \"array\", array = \"twi\", from = 0, to = 1, axis = \"along\" }"),
         "contraction.a.profile.axis: is not used with shape \"array\"; remove axis");
  expect(
      act("profile = { shape = \"gaussian\", axis = \"angle\", sigma_um = 9 }"),
      "contraction.a.profile.sigma_um: is not used with axis \"angle\"; use the key in degrees, or set another axis");
  expect(act("profile = { shape = \"gaussian\", axis = \"angle\" }"),
         "contraction.a.profile.sigma_deg: is missing; set sigma_deg to a number > 0");
  expect(
      act("profile = { shape = \"plateau\", sigma_deg = 4, full_cells = 3, fade_cells = 1 }"),
      "contraction.a.profile.sigma_deg: is not used with shape \"plateau\"; remove it, or set shape to \"gaussian\"");
  expect(
      act("profile = { shape = \"linear\", half_width_deg = 4, half_width_um = 3 }"),
      "contraction.a.profile.half_width_deg: is not used with axis \"across\"; use a length, or set axis to \"angle\"");
  expect(act("profile = { shape = \"linear\", half_width_um = 3, centre_deg = 4 }"),
         "contraction.a.profile.centre_deg: requires axis \"angle\"; remove centre_deg, or set axis to \"angle\"");
  expect(act("profile = { shape = \"linear\", axis = \"angle\", half_width_deg = 3, about = \"all\" }"),
         "contraction.a.profile.about: is not used with axis \"angle\"; remove about; centre_deg sets");
  expect(act("profile = { sigma_deg = 4 }"),
         "contraction.a.profile.shape: is missing; set shape to one of: constant | linear");
  expect(act("profile = { shape = \"table\", factor = [1, 0] }"),
         "contraction.a.profile.at_um: is missing; set at_um or at_cells");
  expect(act("profile = { shape = \"table\", at_um = [1, 2] }"),
         "contraction.a.profile.factor: is missing; set factor to one value");
  expect(act("profile = { shape = \"table\", at_um = [0, 20, 10], factor = [1, 0, 0] }"),
         "contraction.a.profile.at_um: the positions do not increase; list positions in increasing order");
  expect(act("profile = { shape = \"table\", at_um = [0, 20, 30], factor = [1, 0] }"),
         "contraction.a.profile.factor: has length 2 for 3 positions; set factor to as many values as positions");
  expect(act("profile = { shape = \"table\", at_um = [0, 20], factor = [1, -1] }"),
         "contraction.a.profile.factor: -1 is out of range; set factor to a list of numbers >= 0");
  expect(act("profile = { shape = \"table\", at_um = [0, 20], at_cells = [0, 2], factor = [1, 0] }"),
         "profile.at_um: conflicts with contraction.a.profile.at_cells, which is also set; remove one of them");
  expect(act("profile = { shape = \"table\", at_um = [0, 20], factor = [1, 0], middle = 2 }"),
         "contraction.a.profile.middle: is not used with shape \"table\"; remove it");
  expect(act("pulse = { amplitude = 0.5 }"), "test.toml:11: contraction.a.pulse.period_s: is missing; set period_s");
  expect(act("pulse = { period_s = 0 }"),
         "contraction.a.pulse.period_s: 0 is out of range; set period_s to a number >= 1 or \"none\"");
  expect(act("pulse = { period_s = 60, amplitude = 1.5 }"), "contraction.a.pulse.amplitude: 1.5 is out of range");
  expect(act("pulse = { period_s = 60, phase = \"odd\" }"),
         "contraction.a.pulse.phase: \"odd\" is unknown; set phase to one of: random | together");
  expect(
      act("pulse = { period_s = 60 }\n[time]\nstep_s = 10"),
      "contraction.a.pulse.period_s: time steps of 10 s do not resolve a period of 60 s; set time.step_s to at most 5");
  expect(act("variation = { spread = 0.2, by = \"name\" }"),
         "contraction.a.variation.by: \"name\" is unknown; set by to one of: number | place");
  RecordProperty("bad inputs", checked);
  EXPECT_EQ(checked, 34);
}

}  // namespace
}  // namespace plica
