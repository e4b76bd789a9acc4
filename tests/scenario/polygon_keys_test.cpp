// Embryos of polygonal cells: regions, and messages.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <numbers>

#include "core/files.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"

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

TEST(PolygonKeys, RegionsByAngleAndLength) {
  const Scenario scenario = load_scenario({"test", "test.toml",
                                           egg + "[region.belly]\nangle_deg = [-40, 60]\nlength_percent = [25, 80]\n"
                                                 "[region.rest]\nunion = [\"all\"]\nexcept = [\"belly\"]\n"});
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
  std::string table = "x_um,y_um,z_um,gene\n";
  for (int i = 0; i < 200; ++i) {
    const double z = 1 - (2 * i + 1) / 200.0, r = std::sqrt(1 - z * z), turn = 2.4 * i;
    table += std::to_string(120 * z) + ',' + std::to_string(60 * r * std::sin(turn)) + ',' +
             std::to_string(60 * r * std::cos(turn)) + ',' + std::to_string(i) + '\n';
  }
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
  const auto held = make_model(load_scenario({"test", "test.toml", sheet + "\"held\"\n"}));
  std::size_t at_rim = 0;
  for (std::size_t n = 0; n < held->tissue.free_node_count(); ++n) {  // those that hang follow
    const Vec3& x = held->tissue.rest_positions[n];
    const bool is_at_rim = std::abs(x.x()) == 30 || std::abs(x.y()) == 20;
    EXPECT_EQ(held->held[n], (std::array{is_at_rim, is_at_rim, is_at_rim})) << n;
    at_rim += is_at_rim;
  }
  EXPECT_GT(at_rim, 40U);
  const auto free = make_model(load_scenario({"test", "test.toml", sheet + "\"free\"\n"}));
  for (const auto& node : free->held) EXPECT_EQ(node, (std::array{false, false, false}));
}

TEST(PolygonKeys, ARegionSelectedAnewDropsWhatAnotherShapeSelectedItBy) {
  const auto load = [](const std::string& text) { return load_scenario({"test", "test.toml", text}); };
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

  const std::string inherited = errors_of(base + shape), own = errors_of(base + shape + belly + "face = \"left\"\n");
  EXPECT_TRUE(inherited.starts_with("drosophila:")) << inherited;
  EXPECT_NE(inherited.find("region.furrow.face: cells of this shape have no named faces; use angle_deg, "),
            std::string::npos);
  EXPECT_NE(inherited.find("a new selector in [region.furrow] replaces the inherited face"), std::string::npos);
  EXPECT_EQ(own.find("test.toml:7: region.furrow.face: cells of this shape"), 0U) << own;
}

TEST(PolygonKeys, WhatIsWrongIsSaidWithItsKey) {
  const auto expect = [](const std::string& text, const std::string& said) {
    EXPECT_NE(errors_of(text).find(said), std::string::npos) << errors_of(text);
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

}  // namespace
}  // namespace plica
