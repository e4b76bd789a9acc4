// Key `embryo.mirror`: asymmetric input is refused.
#include <gtest/gtest.h>

#include "scenario/load.hpp"
#include "scenario/setup.hpp"

namespace plica {
namespace {

const std::string pill = R"([embryo]
length_um = 300
diameter_um = 160
cell_height_um = 30
cells = [12, 8, 6]
mirror = ["x", "y"]
[region.belly]
face = "ventral"
[region.right]
y_um = [0, 200]
)";

std::vector<std::string> complaints(const std::string& text) {
  try {
    const Scenario scenario = load_scenario({"test", "test.toml", text});
    (void)make_solved_side(scenario, *make_model(scenario));
  } catch (const ScenarioError& error) {
    std::vector<std::string> lines;
    for (const Diagnostic& diagnostic : error.diagnostics()) lines.push_back(diagnostic.text());
    return lines;
  }
  return {};
}

TEST(Symmetry, WhatHasNoImageIsRefused) {
  const std::string right =
      "region \"right\" is not symmetric: it contains cell 95 but not its mirror image, cell 0; use a symmetric "
      "region, or remove embryo.mirror";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"[embryo]\nmirror = [\"z\"]", "test.toml:2: embryo.mirror: \"z\" is unknown; set mirror to a list of: x | y"},
      {"[embryo]\nmirror = [\"y\", \"y\"]", "test.toml:2: embryo.mirror: \"y\" occurs twice; list each direction once"},
      {"[embryo]\ncells = [12, 7, 6]\nmirror = [\"y\"]",
       "test.toml:3: embryo.mirror: the plane y = 0 cuts cells in two, for example cell 36; give an even number of "
       "cells along y"},
      {"[embryo]\nshape = \"slice\"\nlength_um = 7\ncells = [1, 8, 6]\nmirror = [\"x\"]",
       "test.toml:5: embryo.mirror: the plane x = 0 cuts cells in two, for example cell 0; give an even number of "
       "cells along x"},
      {pill + "[division.a]\nregion = \"all\"\nat_s = 5",
       "test.toml:6: embryo.mirror: mirrored cells cannot divide; remove mirror, or [division]"},
      {pill + "[volume]\nmethod = \"projection\"",
       "test.toml:6: embryo.mirror: the paper's algorithm does not support mirror planes; remove mirror, or set "
       "time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
      {pill + "[contraction.a]\nregion = \"right\"\nstiffness_nN_per_um = 1",
       "test.toml:12: contraction.a.region: " + right},
      {pill + "[cortex.a]\nregion = \"right\"\ntension_mN_per_m = 1", "test.toml:12: cortex.a.region: " + right},
      {pill + "[ablation.a]\nregion = \"right\"\nat_s = 1", "test.toml:12: ablation.a.region: " + right},
      {pill + "[pressure.a]\nregion = \"right\"\npressure_Pa = 1", "test.toml:12: pressure.a.region: " + right},
      {pill + "[cortex.a]\nregion = \"belly\"\ntension_mN_per_m = 1\nvariation = { spread = 0.3 }",
       "test.toml:11: cortex.a: is not symmetric: the factor is 0.8292 in cell 0 and 0.5967 in its mirror image, cell "
       "95; make variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[contraction.a]\nregion = \"belly\"\nstiffness_nN_per_um = 1\ndelay = { speed_um_per_s = 1, from = "
              "\"low\" }",
       "test.toml:11: contraction.a: is not symmetric: the delay is 11.48 s in cell 0 and 193 s in its mirror image, "
       "cell 95; make variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[contraction.a]\nregion = \"belly\"\nstiffness_nN_per_um = 1\npulse = { period_s = 60 }",
       "test.toml:11: contraction.a: is not symmetric: the pulse phase is 0.8882 in cell 0 and 0.4079 in its mirror "
       "image, cell 95; make variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[elasticity.a]\nregion = \"belly\"\nprofile = { shape = \"table\", at_um = [-90, 90], factor = [1, 2] }",
       "test.toml:11: elasticity.a: is not symmetric: the factor is 1.235 in cell 0 and 1.765 in its mirror image, "
       "cell 95; make variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[hold.a]\nregion = \"all\"\nz_um = [0, 200]\ny_um = [10, 20]",
       "test.toml:11: hold.a: is not symmetric: only one of the node at -118.731, -11.1918, 0 um and its mirror image "
       "is fixed; use a symmetric region and ranges, or remove embryo.mirror"},
  };
  for (const auto& [text, expected] : cases) {
    const std::vector<std::string> found = complaints(text);
    ASSERT_EQ(found.size(), 1u) << text << (found.empty() ? "" : "\n" + found[0] + "\n" + found.back());
    EXPECT_EQ(found[0], expected) << text;
  }
}

// Regions used for measurement only need not be symmetric.
TEST(Symmetry, RegionsThatAreOnlyMeasuredMayLieOnOneSide) {
  EXPECT_EQ(
      complaints(
          pill +
          "[cortex.a]\nregion = \"belly\"\ntension_mN_per_m = 1\n[monitor.a]\nquantity = \"area\"\nregion = \"right\""),
      std::vector<std::string>{});
}

TEST(Symmetry, WithoutPlanesNothingIsHalved) {
  const Scenario scenario = load_scenario({"test", "test.toml", "[embryo]\ncells = [7, 5, 3]"});
  EXPECT_FALSE(make_solved_side(scenario, *make_model(scenario)));
  EXPECT_TRUE(load_scenario({"test", "test.toml", pill}, {"embryo.mirror=[]"}).embryo.mirror.empty());
}

}  // namespace
}  // namespace plica
