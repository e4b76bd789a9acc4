// Warnings and notes of `plica check` and `plica run` about valid scenarios.
#include "scenario/advice.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "mechanics/obstacles/vitelline.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "support/tissues.hpp"

namespace plica {
namespace {

// Returns the advice on a mesh file whose cells form a block of that size; no file is read.
std::vector<std::string> advice_on_mesh(const Vec3& size_um, bool in_shell = true) {
  const Scenario scenario = load_scenario({"mesh", "mesh.toml",
                                           "[embryo]\nshape = \"file\"\nfile = \"mesh.vtu\"\n[vitelline]\nenabled = " +
                                               std::string(in_shell ? "true" : "false") + "\n"});
  Tissue tissue = build_block(
      {.length_um = size_um.x(), .width_um = size_um.y(), .cell_height_um = size_um.z(), .cells = {2, 2, 1}});
  if (in_shell) tissue.outer_shape = enclosing_capsule(tissue.rest_positions);
  return advice(scenario, Model(std::move(tissue)));
}

std::vector<std::string> lines_with(const std::string& part, const std::vector<std::string>& lines) {
  std::vector<std::string> found;
  std::ranges::copy_if(lines, std::back_inserter(found),
                       [&](const std::string& line) { return line.find(part) != std::string::npos; });
  return found;
}

TEST(Advice, AMeshThatLiesAcrossTheShellIsWarnedOf) {
  for (const auto& [size_um, axis] :
       {std::pair(Vec3(50, 120, 60), "longest along y"), {Vec3(50, 60, 120), "longest along z"}}) {
    const auto warnings = lines_with("the mesh is longest along", advice_on_mesh(size_um));
    ASSERT_EQ(warnings.size(), 1U) << axis;
    EXPECT_TRUE(warnings[0].starts_with("warning: ")) << warnings[0];
    EXPECT_NE(warnings[0].find(axis), std::string::npos) << warnings[0];
    EXPECT_NE(warnings[0].find("rotate the mesh"), std::string::npos) << warnings[0];
  }
}

// A sphere has no longest axis, nor does a mesh within 5 % of one. Without a membrane, orientation is arbitrary.
TEST(Advice, AMeshThatLiesAlongTheShellIsNot) {
  int cases = 0;
  for (const Vec3& size_um : {Vec3(120, 60, 50), Vec3(100, 100, 100), Vec3(100, 104, 100)}) {
    EXPECT_TRUE(lines_with("longest along", advice_on_mesh(size_um)).empty()) << size_um.transpose();
    EXPECT_EQ(lines_with("the vitelline membrane is the spherocylinder along x", advice_on_mesh(size_um)).size(), 1U);
    ++cases;
  }
  EXPECT_TRUE(lines_with("longest along", advice_on_mesh({50, 120, 60}, false)).empty());
  EXPECT_EQ(cases, 3);
}

// A misspelt name in an inherited table defines a new table without effect.
TEST(Advice, WhatDoesNothingIsTold) {
  const Scenario scenario = load_scenario({"typo", "typo.toml",
                                           "base = \"drosophila\"\n[region.furow]\nx_um = [0, 50]\n"
                                           "[contraction.apicl]\nregion = \"all\"\n"});
  const auto lines = advice(scenario, *make_model(scenario));
  EXPECT_EQ(lines_with("region.furow: no table uses this region", lines).size(), 1U);
  EXPECT_EQ(lines_with("contraction.apicl: has no effect, since stiffness", lines).size(), 1U);
  EXPECT_TRUE(lines_with("region.furrow: nothing", lines).empty());
}

// A fold beside the midline has no furrow measures.
TEST(Advice, AFurrowBesideTheMidlineIsTold) {
  const std::string flank =
      "base = \"drosophila\"\n[region.flank]\nangle_deg = [60, 120]\n[contraction.apical]\nregion = ";
  const auto told = [&](const std::string& region) {
    const Scenario scenario = load_scenario({"side", "side.toml", flank + region});
    return lines_with("does not intersect the plane y = 0", advice(scenario, *make_model(scenario)));
  };
  ASSERT_EQ(told("\"flank\"").size(), 1U);
  EXPECT_TRUE(told("\"flank\"")[0].starts_with("warning: region flank does not intersect"));
  EXPECT_TRUE(told("\"furrow\"").empty());
  EXPECT_TRUE(told("\"all\"").empty());
}

// A stripe, or half, of a sheet of polygons with a constant tension, and tables whose tension ends softly.
std::vector<std::string> advice_on_stripe(const std::string& region, const std::string& table,
                                          const std::vector<std::string>& overrides = {}) {
  const std::string sheet =
      "format = 1\n[embryo]\nshape = \"sheet\"\nlength_um = 50\nwidth_um = 50\ncell_count = 100\ncell_height_um = 15\n";
  const Scenario scenario =
      load_scenario({"stripe", "stripe.toml", sheet + "[region.stripe]\n" + region + "\n" + table}, overrides);
  return lines_with("no limit under refinement", advice(scenario, *make_model(scenario)));
}

TEST(Advice, AConstantTensionThatEndsAbruptlyIsToldWithAProfileThatDoesNot) {
  const std::string springs = "[contraction.apical]\nregion = \"stripe\"\n",
                    cortex = "[cortex.apical]\nregion = \"stripe\"\ntension_mN_per_m = 2\n";
  int told = 0;
  for (const auto& [region, table, axis] : {std::tuple("y_um = [-12, 12]", springs + "tension_mN_per_m = 2", "across"),
                                            {"y_um = [-12, 12]", springs + "preload_nN = 20", "across"},
                                            {"x_um = [-12, 12]", cortex, "along"}}) {
    const auto lines = advice_on_stripe(region, table);
    ASSERT_EQ(lines.size(), 1U) << table;
    const std::string before = "refinement; set ", after = ".profile = ";
    const std::size_t begin = lines[0].find(before), middle = lines[0].find(after);
    ASSERT_LT(middle, lines[0].size()) << lines[0];
    EXPECT_NE(lines[0].find(axis), std::string::npos) << lines[0];
    // The remedy, as it stands.
    const std::string profile = "profile = " + lines[0].substr(middle + after.size()) + "\n";
    EXPECT_TRUE(advice_on_stripe(region, table + "\n" + profile).empty()) << lines[0].substr(begin);
    ++told;
  }
  EXPECT_EQ(told, 3);
  EXPECT_TRUE(advice_on_stripe("y_um = [-12, 12]", springs + "stiffness_nN_per_um = 2").empty());
  EXPECT_TRUE(advice_on_stripe("y_um = [-12, 12]", cortex + "saturation_ratio = 0.2").empty());
  EXPECT_TRUE(advice_on_stripe("y_um = [-99, 99]", cortex).empty());
}

// The key is one that the scenario has, and it ends the note.
TEST(Advice, OneElementThroughTheHeightIsTold) {
  const std::string stripe =
      "[region.stripe]\ny_um = [-12, 12]\n[contraction.apical]\nregion = \"stripe\"\n"
      "stiffness_nN_per_um = 1\n";
  int cases = 0;
  for (const auto& [shape, key] : {std::pair("sheet\"\ncell_count = 50\n", "embryo.layers = 2"),
                                   {"block\"\ncells = [5, 8, 1]\n", "embryo.elements_per_cell = [1, 1, 2]"}}) {
    const std::string text = "format = 1\n[embryo]\nlength_um = 30\nwidth_um = 50\ncell_height_um = 12\nshape = \"" +
                             std::string(shape) + stripe;
    const auto lines = [&](const std::vector<std::string>& overrides) {
      const Scenario scenario = load_scenario({"stripe", "stripe.toml", text}, overrides);
      return lines_with("one element through the height", advice(scenario, *make_model(scenario)));
    };
    ASSERT_EQ(lines({}).size(), 1U) << shape;
    EXPECT_NE(lines({})[0].find(key), std::string::npos) << lines({})[0];
    EXPECT_TRUE(lines({key}).empty()) << key;
    EXPECT_TRUE(lines({"elasticity.model=neo-hookean"}).empty());
    ++cases;
  }
  EXPECT_EQ(cases, 2);
}

TEST(Advice, BuiltInTensionsEndSoftly) {
  int cases = 0;
  for (const std::string name : {"drosophila", "wing-disc", "furrow-slice"}) {
    const Scenario scenario = load_scenario(find_scenario(name), {});
    EXPECT_TRUE(lines_with("no limit under refinement", advice(scenario, *make_model(scenario))).empty()) << name;
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

// A sheet has a fold, and no lips.
TEST(Advice, WordsFitTheTissue) {
  const Scenario scenario = load_scenario({"flat", "flat.toml", R"([embryo]
shape = "sheet"
length_um = 60
width_um = 60
cell_count = 60
cell_height_um = 10
[region.side]
y_um = [10, 25]
[contraction.apical]
region = "side"
stiffness_nN_per_um = 1
)"});
  const auto lines = lines_with("does not intersect the plane y = 0", advice(scenario, *make_model(scenario)));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("so the fold depth has no value; use [monitor.NAME]"), std::string::npos) << lines[0];
}

TEST(Advice, AProgramThatTheRunCutsOffIsTold) {
  const Scenario scenario = load_scenario(find_scenario("furrow-slice"), {"time.end_min=15"});
  const auto warnings = lines_with("program extends beyond", advice(scenario, *make_model(scenario)));
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_EQ(warnings[0],
            "warning: cortex.floor: program extends beyond the end of the run (900 s); change program or time.end_s");
}

}  // namespace
}  // namespace plica
