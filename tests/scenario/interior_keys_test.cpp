// Keys of elasticity: moduli by region, the neo-Hookean law, relaxation.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenario/advice.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "simulation/simulation.hpp"
#include "support/block_scenario.hpp"

namespace plica {
namespace {

std::vector<std::string> lines_of(const ScenarioError& error) {
  std::vector<std::string> lines;
  for (const Diagnostic& diagnostic : error.diagnostics()) lines.push_back(diagnostic.text());
  return lines;
}

std::vector<std::string> complaints(const std::string& text) {
  try {
    (void)make_model(load_scenario({"test", "test.toml", text}));
  } catch (const ScenarioError& error) {
    return lines_of(error);
  }
  return {};
}

void expect_complaints(const std::vector<std::pair<std::string, std::string>>& cases) {
  for (const auto& [text, expected] : cases) {
    const std::vector<std::string> found = complaints(text);
    ASSERT_EQ(found.size(), 1u) << text << (found.empty() ? "" : "\n" + found[0] + "\n" + found.back());
    EXPECT_EQ(found[0], expected) << text;
  }
}

TEST(InteriorKeys, ModuliByRegionSayWhatWouldBeRight) {
  const std::string soft = "[elasticity.soft]\nregion = \"all\"\n";
  const std::string two =
      "[region.left]\nface = \"ventral\"\n[region.belly]\nface = \"ventral\"\ncells_across = 1\n"
      "[elasticity.soft]\nregion = \"left\"\nyoung_modulus_Pa = 5\n[elasticity.stiff]\nregion = \"belly\"\n"
      "young_modulus_Pa = 50\n";
  expect_complaints({
      {soft,
       "test.toml:1: elasticity.soft: has no effect; set young_modulus_Pa, poisson_ratio, relaxation_min, profile or "
       "variation"},
      {"[elasticity.soft]\nyoung_modulus_Pa = 5",
       "test.toml:1: elasticity.soft.region: is missing; set region to a text"},
      {soft + "young_modulus_Pa = 0",
       "test.toml:3: elasticity.soft.young_modulus_Pa: 0 is out of range; set young_modulus_Pa to a number > 0"},
      {soft + "young_modulus_Pa = 5\npoisson_ratio = 0.5",
       "test.toml:4: elasticity.soft.poisson_ratio: 0.5 is out of range; set poisson_ratio to a number > -1 and < 0.5"},
      {"[elasticity]\nmodel = \"neo-hookean\"\n" + soft + "poisson_ratio = -0.2",
       "test.toml:5: elasticity.soft.poisson_ratio: -0.2 is below 0, the minimum with model \"neo-hookean\"; set "
       "poisson_ratio to a number >= 0, or model to \"corotational\""},
      {soft + "young_modulus_Pa = 5\nheight_percent = [80, 100]",
       "test.toml:4: elasticity.soft.height_percent: no element of the region has its centre in this part of the "
       "height; widen height_percent, or increase embryo.elements_per_cell through the height"},
      {"[embryo]\nelements_per_cell = [1, 1, 3]\n[region.belly]\nface = \"ventral\"\n" + soft +
           "young_modulus_Pa = 5\nheight_percent = [60, 100]\n[elasticity.apex]\nregion = \"belly\"\n"
           "height_percent = [80, 100]\npoisson_ratio = 0.3",
       "test.toml:5: elasticity.soft: overlaps elasticity.apex in the same layer of cell 0 at (-154.4, -67.53, -74.13) "
       "um; set height_percent to disjoint ranges, or use disjoint regions"},
      {soft + "young_modulus_Pa = 5\nheight_percent = [80, 10]",
       "test.toml:4: elasticity.soft.height_percent: low is above high; set height_percent to [low, high], 0 to 100"},
      {soft + "profile = { shape = \"linear\", half_width_um = 20 }",
       "test.toml:3: elasticity.soft.profile: the modulus of cell 0 at (-154.4, -67.53, -74.13) um would be 0; set "
       "profile.edge or profile.factor above 0"},
      {soft + "young_modulus_Pa = 5\nheight_percent = [0, 50]\n[division.d]\nregion = \"all\"\nat_s = 9",
       "test.toml:4: elasticity.soft.height_percent: cells with layers cannot divide; remove height_percent, or "
       "[division]"},
      {"[elasticity.soft]\nregion = \"belly\"\nyoung_modulus_Pa = 5",
       "test.toml:2: elasticity.soft.region: region \"belly\" does not exist; use one of: all"},
      {"[elasticity]\nmodel = \"shape-memory\"\n" + soft + "young_modulus_Pa = 5",
       "test.toml:3: elasticity.soft: model \"shape-memory\" does not support regions; remove the table, or set "
       "elasticity.model to \"corotational\" or \"neo-hookean\""},
      {two,
       "test.toml:9: elasticity.stiff: overlaps elasticity.soft in cell 72 at (-167.4, 0, -90.53) um; use disjoint "
       "regions, for example with `except`"},
  });
}

TEST(InteriorKeys, NeoHookeanAndFlowSayWhatWouldBeRight) {
  const std::string neo = "[elasticity]\nmodel = \"neo-hookean\"\n";
  const std::string soft = "[elasticity.soft]\nregion = \"all\"\n";
  expect_complaints({
      {"[elasticity]\nmodel = \"neohookean\"",
       "test.toml:2: elasticity.model: \"neohookean\" is unknown; set model to one of: corotational | neo-hookean | "
       "shape-memory (nearest match: \"neo-hookean\")"},
      {"[elasticity]\nrelaxation_min = 6",
       "test.toml:2: elasticity.relaxation_min: is not used with model \"corotational\"; remove it, or set "
       "elasticity.model to \"neo-hookean\""},
      {"[elasticity]\nmodel = \"shape-memory\"\nrelaxation_s = 6",
       "test.toml:3: elasticity.relaxation_s: is not used with model \"shape-memory\"; remove it, or set "
       "elasticity.model to \"neo-hookean\""},
      {neo + "relaxation_min = 0",
       "test.toml:3: elasticity.relaxation_min: 0 is out of range; set relaxation_min to a number > 0 or \"none\""},
      {neo + "attractor_preload_nN = 1",
       "test.toml:3: elasticity.attractor_preload_nN: is not used with model \"neo-hookean\"; remove it, or set "
       "elasticity.model to \"shape-memory\""},
      {neo + "poisson_ratio = -0.2",
       "test.toml:3: elasticity.poisson_ratio: -0.2 is below 0, the minimum with model \"neo-hookean\"; set "
       "poisson_ratio to a number >= 0, or model to \"corotational\""},
      {neo + "[dynamics]\nshear_viscosity_Pa_s = 10",
       "test.toml:4: dynamics.shear_viscosity_Pa_s: model \"neo-hookean\" does not support shear viscosity; set it to "
       "0 and use elasticity.relaxation_min, or set elasticity.model to \"corotational\""},
      {soft + "relaxation_min = 6",
       "test.toml:3: elasticity.soft.relaxation_min: is not used with model \"corotational\"; remove it, or set "
       "elasticity.model to \"neo-hookean\""},
      {neo + soft + "relaxation_min = \"none\"",
       "test.toml:5: elasticity.soft.relaxation_min: \"none\" has the wrong type; set relaxation_min to a number > 0"},
      {neo + soft + "relaxation_min = 6\nrelaxation_s = 6",
       "test.toml:6: elasticity.soft.relaxation_s: conflicts with elasticity.soft.relaxation_min, which is also set; "
       "remove one of them"},
  });
}

// Relaxation of one region only, and the dilatation law of neo-Hookean cells.
TEST(InteriorKeys, WhatTheyMakeOfTheModel) {
  const auto laws = [](const std::string& more) {
    const auto model = make_model(load_scenario(support::pulled_block(more)));
    std::string names;
    std::size_t remembered = 0;
    for (const auto& law : model->laws) {
      names += std::string(law->name()) + ", ";
      remembered += law->first_internal(model->tissue).size();
    }
    return names + std::to_string(remembered);
  };
  const std::string neo = "[elasticity]\nmodel = \"neo-hookean\"\n";
  EXPECT_EQ(laws(neo), "elasticity, dilatation, contraction, drag, 0");
  EXPECT_EQ(laws(neo + "poisson_ratio = 0\n"), "elasticity, contraction, drag, 0");
  EXPECT_EQ(laws(neo + "relaxation_min = 6\n"), "elasticity, dilatation, contraction, drag, 768");
  EXPECT_EQ(laws(neo + "[region.one]\nids = [1]\n[elasticity.soft]\nregion = \"one\"\nrelaxation_min = 6\n"),
            "elasticity, dilatation, contraction, drag, 768");
}

// Bending of single neo-Hookean elements is too soft; warned of if it matters.
TEST(InteriorKeys, BendingOfOneNeoHookeanElementIsWarnedOf) {
  const auto warnings = [](const std::string& more) {
    const Scenario scenario = load_scenario(support::pulled_block("[elasticity]\nmodel = \"neo-hookean\"\n" + more));
    const std::vector<std::string> lines = advice(scenario, *make_model(scenario));
    return std::ranges::count_if(lines, [](const std::string& line) {
      return line.starts_with("warning: neo-hookean cells of one element bend 45 % more easily");
    });
  };
  EXPECT_EQ(warnings(""), 1);
  EXPECT_EQ(warnings("poisson_ratio = 0\n"), 0);
}

// Column of two cells under pressure: each shortens by pressure / its own modulus.
TEST(InteriorKeys, ASoftCellIsShortenedMore) {
  const Scenario scenario = load_scenario({"column", "column.toml", R"(format = 1
[embryo]
shape = "block"
length_um = 20
width_um = 20
cell_height_um = 20
cells = [1, 1, 2]
[region.low]
ids = [0]
[region.high]
ids = [1]
[elasticity]
young_modulus_Pa = 1000
poisson_ratio = 0
[elasticity.soft]
region = "high"
young_modulus_Pa = 250
[volume]
method = "none"
[hold.foot]
region = "low"
z_um = [-20, -20]
[pressure.lid]
region = "high"
pressure_Pa = 1
[time]
end_min = 5
[stop]
equilibrium_speed_um_per_min = 1e-6
)"});
  Simulation simulation(scenario);
  ASSERT_EQ(simulation.run(), RunStatus::equilibrium) << simulation.failure();
  const Tissue& tissue = simulation.model().tissue;
  double middle = 0, top = 0;
  for (std::size_t n = 0; n < tissue.node_count(); ++n) {
    const double z = tissue.rest_positions[n].z(), moved = simulation.state().positions[n].z() - z;
    if (std::abs(z) < 1e-9) middle += moved / 4;
    if (z > 10) top += moved / 4;
  }
  EXPECT_NEAR(middle, -20 * 1e-3, 2e-5);
  EXPECT_NEAR(top - middle, -20 * 4e-3, 2e-4);
}

// A region of all cells is equivalent to the common modulus.
TEST(InteriorKeys, ARegionOfAllCellsIsLikeNone) {
  const auto end = [](const std::string& more) {
    Simulation simulation(load_scenario(support::pulled_block(more)));
    EXPECT_EQ(simulation.run(), RunStatus::end_time);
    return simulation.state().positions;
  };
  for (const std::string volume : {"[volume]\nmethod = \"none\"\n", ""}) {
    const Vectors a = end("[elasticity]\nyoung_modulus_Pa = 300\n" + volume);
    const Vectors b = end("[elasticity.all]\nregion = \"all\"\nyoung_modulus_Pa = 300\n" + volume);
    const Vectors other = end(volume);
    double apart = 0, without = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      apart = std::max(apart, (a[n] - b[n]).norm());
      without = std::max(without, (a[n] - other[n]).norm());
    }
    EXPECT_LE(apart, 1e-6);
    EXPECT_GT(without, 0.1);
  }
}

}  // namespace
}  // namespace plica
