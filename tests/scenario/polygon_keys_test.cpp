// Keys of sheets and embryos of polygons, and of periods.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/files.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "support/scenarios.hpp"
#include "tissue/faces.hpp"

namespace plica {
namespace {

using namespace support;

TEST(PolygonKeys, RegionsByAngleAndLength) {
  const Scenario scenario = load_scenario({"test", "test.toml",
                                           egg + "[region.belly]\nangle_deg = [-40, 60]\nlength_percent = [25, "
                                                 "80]\n[region.rest]\nunion = [\"all\"]\nexcept = [\"belly\"]\n"});
  const Tissue tissue = make_tissue(scenario);
  int inside = 0;
  for (std::size_t c = 0; c < tissue.cells.size(); ++c) {
    const Vec3 centre = cell_centre(tissue.cells[c], tissue.rest_positions);
    const double angle = std::atan2(centre.y(), -centre.z()) * 180 / std::numbers::pi;
    // The egg is 250 long, so that 25 % are 62.5 from its end.
    const bool is_in = angle >= -40 && angle <= 60 && centre.x() >= -62.5 && centre.x() <= 75;
    if (std::abs(centre.x() + 62.5) > 1 && std::abs(centre.x() - 75) > 1) {
      EXPECT_EQ(tissue.regions.at("belly")[c], is_in) << c;
    }
    EXPECT_NE(tissue.regions.at("belly")[c], tissue.regions.at("rest")[c]);
    inside += is_in;
  }
  EXPECT_GT(inside, 20);
}

TEST(PolygonKeys, RegionsOfMeasuredArrays) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("plica_points_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const std::string table = numbered_points("gene");
  write_file(folder / "points.csv", table);
  const std::string points = "format = 1\n[embryo]\nshape = \"points\"\nfile = \"points.csv\"\ncell_height_um = 15\n";
  const auto tissue_of = [&](const std::string& regions) {
    return make_tissue(load_scenario({"test", (folder / "test.toml").string(), points + regions}));
  };
  const Tissue tissue = tissue_of(
      "[region.some]\narray = \"gene\"\nabove = 50\nbelow = 60\n[region.any]\narray = \"gene\"\n[region.low]\narray = "
      "\"gene\"\nbelow = 3\n");
  for (std::size_t c = 0; c < 200; ++c) {
    EXPECT_EQ(tissue.regions.at("some")[c], c > 50 && c < 60);
    EXPECT_EQ(tissue.regions.at("any")[c], c != 0);
    EXPECT_EQ(tissue.regions.at("low")[c], c < 3);
  }
  EXPECT_THROW(tissue_of("[region.r]\narray = \"other\"\n"), ScenarioError);
  write_file(folder / "points.csv", table + "0,0,61,1\n0,0,61,1\n");
  EXPECT_THROW(tissue_of(""), ScenarioError);
  std::filesystem::remove_all(folder);
}

TEST(PolygonKeys, AHeldRimIsHeldAndNothingElse) {
  const std::string sheet =
      "format = 1\n[embryo]\nshape = \"sheet\"\nlength_um = 60\nwidth_um = 40\ncell_count = 40\ncell_height_um = "
      "9\nrim = ";
  const auto held = make_model(scenario_of(sheet + "\"held\"\n"));
  std::size_t at_rim = 0;
  for (std::size_t n = 0; n < held->tissue.free_node_count(); ++n) {  // those that hang follow
    const Vec3& x = held->tissue.rest_positions[n];
    const bool is_at_rim = std::abs(x.x()) == 30 || std::abs(x.y()) == 20;
    EXPECT_EQ(held->held[n], (std::array{is_at_rim, is_at_rim, is_at_rim})) << n;
    at_rim += is_at_rim;
  }
  EXPECT_GT(at_rim, 40U);
  const auto free = make_model(scenario_of(sheet + "\"free\"\n"));
  for (const auto& node : free->held) EXPECT_EQ(node, (std::array{false, false, false}));
}

TEST(PolygonKeys, ARegionSelectedAnewDropsWhatAnotherShapeSelectedItBy) {
  const auto load = [](const std::string& text) { return scenario_of(text); };
  const std::string base = "base = \"drosophila\"\n", shape = "[embryo]\nshape = \"egg\"\ncell_count = 300\n",
                    belly = "[region.furrow]\nangle_deg = [-30, 30]\n";
  const RegionInput furrow = load(base + shape + belly).regions.at("furrow");
  EXPECT_EQ(furrow.face, "");
  EXPECT_FALSE(furrow.cells_along || furrow.cells_across);
  EXPECT_TRUE(furrow.angle_deg);
  // For shapes with faces, selectors are intersected.
  EXPECT_EQ(load(base + belly).regions.at("furrow").face, "ventral");
  // Likewise for arrays.
  const std::string pill =
      "base = \"drosophila-atlas\"\n[embryo]\nshape = \"pill\"\n[region.mesoderm]\nface = \"left\"\n";
  EXPECT_EQ(load(pill).regions.at("mesoderm").array, "");
  EXPECT_FALSE(load(pill).regions.at("mesoderm").above);

  const std::string inherited = model_errors(base + shape),
                    own = model_errors(base + shape + belly + "face = \"left\"\n");
  EXPECT_TRUE(inherited.starts_with("drosophila:")) << inherited;
  EXPECT_NE(inherited.find("region.furrow.face: cells of this shape have no named faces; use angle_deg, "),
            std::string::npos);
  EXPECT_NE(inherited.find("a new selector in [region.furrow] replaces the inherited face"), std::string::npos);
  EXPECT_EQ(own.find("test.toml:7: region.furrow.face: cells of this shape"), 0U) << own;
}

TEST(PolygonKeys, WhatIsWrongIsSaidWithItsKey) {
  const auto expect = [](const std::string& text, const std::string& said) {
    EXPECT_NE(model_errors(text).find(said), std::string::npos) << model_errors(text);
  };
  expect("format = 1\n[embryo]\nshape = \"points\"\n", "embryo.file: is missing; set file to the table of points");
  expect("format = 1\n[embryo]\nshape = \"points\"\nfile = \"nowhere.csv\"\n", "embryo.file: ");
  expect("format = 1\n[embryo]\nshape = \"points\"\nfile = \"builtin:mouse\"\n",
         "table builtin:mouse does not exist; use one of: builtin:drosophila_atlas");
  expect("format = 1\n[embryo]\nshape = \"points\"\nfile = \"a.csv\"\nscale = [1, 2]\n",
         "embryo.scale: has length 2; set scale to three");
  expect(egg + "belly_sag_um = 9\n", "embryo.belly_sag_um: requires back_sag_um; set both keys");
  expect(egg + "belly_sag_um = 60\nback_sag_um = 2\n", "embryo: ");
  expect(egg + "cells = [3, 3, 3]\n", "embryo.cells: is not used with shape \"egg\"");
  expect(egg + "elements = \"triangles\"\n", "embryo.elements: ");
  expect(egg + "least_edge_ratio = 0.9\n", "embryo.least_edge_ratio: ");
  expect(egg + "[region.r]\nface = \"ventral\"\n", "region.r.face: cells of this shape have no named faces");
  expect(egg + "[region.r]\narray = \"sna\"\n",
         "region.r.array: the embryo has no array \"sna\"; set embryo.cell_arrays to a table with this column");
  expect(egg + "[region.r]\nx_um = [-10, 10]\nabove = 2\n", "region.r.above: is not used without array");
  expect(egg + "[region.r]\nangle_deg = [170, 175]\nlength_percent = [0, 0.1]\n",
         "region.r: contains no cell of the embryo");
  expect(egg + "[contraction.c]\nregion = \"all\"\nedges = \"apical\"\nstiffness_nN_per_um = 1\ndiagonals = true\n",
         "contraction.c.diagonals: cell ");
  expect(egg + "elements = \"kites\"\n[division.d]\nregion = \"all\"\nat_s = 10\n",
         "consist of kites or of several layers");
  expect(egg + "[volume]\nmethod = \"projection\"\n",
         "test.toml:9: volume.method: the paper's algorithm supports four-sided cells only, but this tissue has "
         "polygonal cells; set method to \"coupled\" or \"none\"");
  expect(egg + "[time]\nscheme = \"linearly-implicit\"\n[volume]\nmethod = \"none\"\n",
         "test.toml:9: time.scheme: the paper's algorithm supports four-sided cells only");
}

const std::string sheet = R"([embryo]
shape = "sheet"
length_um = 60
width_um = 50
cell_count = 60
cell_height_um = 10
)";

std::unique_ptr<Model> model_of(const std::string& text) { return make_model(scenario_of(text)); }

TEST(PeriodicKeys, WhatDoesNotGoWithThemIsRefused) {
  const std::string both = sheet + "periodic = [\"x\", \"y\"]\n", along = sheet + "periodic = [\"x\"]\n";
  const WrongScenarios cases = {
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
  expect_errors(cases, side_errors);
  const std::string few = side_errors(
      "[embryo]\nshape = \"sheet\"\nlength_um = 10\nwidth_um = 90\ncell_count = 20\ncell_height_um = 9\nperiodic = "
      "[\"x\"]");
  EXPECT_NE(few.find("across the period; lengthen the period, or give more cells (about four along it)"),
            std::string::npos)
      << few;
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
  const auto model = model_of(
      sheet + "periodic = [\"x\", \"y\"]\n[region.end]\nx_um = [24, 30]\n[region.beside]\nneighbours_of = \"end\"\n");
  const CellSet& beside = model->tissue.regions.at("beside");
  std::size_t far = 0;
  for (std::size_t c = 0; c < beside.size(); ++c)
    far += beside[c] && cell_centre(model->tissue.cells[c], model->tissue.rest_positions).x() < -20;
  EXPECT_GT(far, 3U);
}

}  // namespace
}  // namespace plica
