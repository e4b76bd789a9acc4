// Key `embryo.periodic`: periodic sheets, and incompatible keys.
#include <gtest/gtest.h>

#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

const std::string sheet = R"([embryo]
shape = "sheet"
length_um = 60
width_um = 50
cell_count = 60
cell_height_um = 10
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

std::unique_ptr<Model> model_of(const std::string& text) {
  return make_model(load_scenario({"test", "test.toml", text}));
}

TEST(PeriodicKeys, WhatDoesNotGoWithThemIsRefused) {
  const std::string both = sheet + "periodic = [\"x\", \"y\"]\n", along = sheet + "periodic = [\"x\"]\n";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {sheet + "periodic = [\"z\"]",
       "test.toml:7: embryo.periodic: \"z\" is unknown; set periodic to a list of: x | y"},
      {sheet + "periodic = [\"x\", \"x\"]",
       "test.toml:7: embryo.periodic: \"x\" occurs twice; list each direction once"},
      {"[embryo]\nshape = \"egg\"\nperiodic = [\"x\"]",
       "test.toml:3: embryo.periodic: is not used with shape \"egg\"; remove periodic, or set shape to sheet"},
      {along + "curvature_per_um = [0.004, 0.004]",
       "test.toml:8: embryo.curvature_per_um: a sheet curved along x cannot be periodic along x; set its curvature "
       "there to 0, or remove \"x\" from embryo.periodic"},
      {both + "rim = \"held\"",
       "test.toml:8: embryo.rim: a sheet periodic along x and y has no boundary; remove rim, or one direction of "
       "embryo.periodic"},
      {along + "[division.a]\nregion = \"all\"\nat_s = 5",
       "test.toml:7: embryo.periodic: cells of a periodic sheet cannot divide; remove periodic, or [division]"},
      {along + "mirror = [\"y\"]",
       "test.toml:8: embryo.mirror: a periodic sheet cannot be reduced to one side; remove it, or embryo.periodic"},
      {along + "[volume]\nmethod = \"projection\"",
       "test.toml:7: embryo.periodic: the paper's algorithm does not support periodic sheets; remove periodic, or set "
       "time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
      {both + "[enclosed.yolk]\nvolume = \"held\"",
       "test.toml:8: enclosed.yolk: a sheet encloses no volume; remove the table, or set embryo.shape to \"pill\" or "
       "\"sphere\""},
  };
  for (const auto& [text, expected] : cases) {
    SCOPED_TRACE(text);
    EXPECT_EQ(complaints(text), std::vector{expected});
  }
  const std::vector<std::string> few = complaints(
      "[embryo]\nshape = \"sheet\"\nlength_um = 10\nwidth_um = 90\n"
      "cell_count = 20\ncell_height_um = 9\nperiodic = [\"x\"]");
  ASSERT_EQ(few.size(), 1U);
  EXPECT_NE(few[0].find("across the period; lengthen the period, or give more cells (about four along it)"),
            std::string::npos)
      << few[0];
}

TEST(PeriodicKeys, ThePartsOfTheRimThatAreLeftAreHeld) {
  const auto model = model_of(sheet + "periodic = [\"x\"]\nrim = \"held\"");
  const Tissue& tissue = model->tissue;
  std::size_t held = 0;
  for (std::size_t n = 0; n < tissue.free_node_count(); ++n) {
    const bool is_at_rim = std::abs(tissue.rest_positions[n].y()) == 25;
    EXPECT_EQ(model->held[n], (std::array{is_at_rim, is_at_rim, is_at_rim})) << n;
    held += is_at_rim;
  }
  EXPECT_GT(held, 20U);
}

// A hold at the far end of a period fixes the periodic originals.
TEST(PeriodicKeys, AHoldOfAnImageHolds) {
  const auto model = model_of(sheet + "periodic = [\"x\", \"y\"]\n[hold.end]\nregion = \"all\"\nx_um = [30, 40]\n");
  std::size_t held = 0;
  for (std::size_t n = 0; n < model->tissue.free_node_count(); ++n)
    if (model->held[n][0]) {
      const double x = model->tissue.rest_positions[n].x();
      EXPECT_TRUE(x >= 30 - 1e-9 || x + 60 >= 30 - 1e-9) << x;
      held += x < 0;
    }
  EXPECT_GT(held, 4U);
}

TEST(PeriodicKeys, RegionsReachAcrossTheEnd) {
  const auto model = model_of(sheet +
                              "periodic = [\"x\", \"y\"]\n[region.end]\nx_um = [24, 30]\n[region.beside]\n"
                              "neighbours_of = \"end\"\n");
  const CellSet& beside = model->tissue.regions.at("beside");
  std::size_t far = 0;
  for (std::size_t c = 0; c < beside.size(); ++c)
    far += beside[c] && cell_centre(model->tissue.cells[c], model->tissue.rest_positions).x() < -20;
  EXPECT_GT(far, 3U);
}

}  // namespace
}  // namespace plica
