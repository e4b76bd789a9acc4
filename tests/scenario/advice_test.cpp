// Warnings and notes of `plica check` and `plica run`, and the remedies that they name: each is tried.
#include "scenario/advice.hpp"

#include "mechanics/obstacles/vitelline.hpp"
#include "support/scenarios.hpp"
#include "support/tissues.hpp"

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
    EXPECT_SAYS(warnings[0], axis);
    EXPECT_SAYS(warnings[0], "rotate the mesh");
  }
}

// A sphere has no longest axis, nor does a mesh within 5 % of one. Without a membrane, orientation is arbitrary.
TEST(Advice, AMeshThatLiesAlongTheShellIsNot) {
  for (const Vec3& size_um : {Vec3(120, 60, 50), Vec3(100, 100, 100), Vec3(100, 104, 100)}) {
    EXPECT_TRUE(lines_with("longest along", advice_on_mesh(size_um)).empty()) << size_um.transpose();
    EXPECT_EQ(lines_with("the vitelline membrane is the spherocylinder along x", advice_on_mesh(size_um)).size(), 1U);
  }
  EXPECT_TRUE(lines_with("longest along", advice_on_mesh({50, 120, 60}, false)).empty());
}

// A misspelt name in an inherited table defines a new table without effect.
TEST(Advice, WhatDoesNothingIsTold) {
  const Scenario scenario =
      load_scenario({"typo", "typo.toml",
                     "base = \"drosophila\"\n[region.furow]\nx_um = [0, 50]\n[contraction.apicl]\nregion = \"all\"\n"});
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
  for (const auto& [region, table, axis] : {std::tuple("y_um = [-12, 12]", springs + "tension_mN_per_m = 2", "across"),
                                            {"y_um = [-12, 12]", springs + "preload_nN = 20", "across"},
                                            {"x_um = [-12, 12]", cortex, "along"}}) {
    const auto lines = advice_on_stripe(region, table);
    ASSERT_EQ(lines.size(), 1U) << table;
    const std::string before = "refinement; set ", after = ".profile = ";
    const std::size_t begin = lines[0].find(before), middle = lines[0].find(after);
    ASSERT_LT(middle, lines[0].size()) << lines[0];
    EXPECT_SAYS(lines[0], axis);
    // The remedy, as it stands.
    const std::string profile = "profile = " + lines[0].substr(middle + after.size()) + "\n";
    EXPECT_TRUE(advice_on_stripe(region, table + "\n" + profile).empty()) << lines[0].substr(begin);
  }
  EXPECT_TRUE(advice_on_stripe("y_um = [-12, 12]", springs + "stiffness_nN_per_um = 2").empty());
  EXPECT_TRUE(advice_on_stripe("y_um = [-12, 12]", springs + "preload_nN = 20\nborder = \"all\"").empty());
  EXPECT_TRUE(advice_on_stripe("y_um = [-12, 12]", cortex + "saturation_ratio = 0.2").empty());
  EXPECT_TRUE(advice_on_stripe("y_um = [-99, 99]", cortex).empty());
}

// The key is one that the scenario has, and it ends the note.
TEST(Advice, OneElementThroughTheHeightIsTold) {
  const std::string stripe =
      "[region.stripe]\ny_um = [-12, 12]\n[contraction.apical]\nregion = \"stripe\"\nstiffness_nN_per_um = 1\n";
  for (const auto& [shape, key] : {std::pair("sheet\"\ncell_count = 50\n", "embryo.layers = 2"),
                                   {"block\"\ncells = [5, 8, 1]\n", "embryo.elements_per_cell = [1, 1, 2]"}}) {
    const std::string text = "format = 1\n[embryo]\nlength_um = 30\nwidth_um = 50\ncell_height_um = 12\nshape = \"" +
                             std::string(shape) + stripe;
    const auto lines = [&](const std::vector<std::string>& overrides) {
      const Scenario scenario = load_scenario({"stripe", "stripe.toml", text}, overrides);
      return lines_with("one element through the height", advice(scenario, *make_model(scenario)));
    };
    ASSERT_EQ(lines({}).size(), 1U) << shape;
    EXPECT_SAYS(lines({})[0], key);
    EXPECT_TRUE(lines({key}).empty()) << key;
    EXPECT_TRUE(lines({"elasticity.model=neo-hookean"}).empty());
  }
}

TEST(Advice, BuiltInTensionsEndSoftly) {
  for (const std::string name : {"drosophila", "wing-disc", "furrow-slice"}) {
    const Scenario scenario = load_scenario(find_scenario(name), {});
    EXPECT_TRUE(lines_with("no limit under refinement", advice(scenario, *make_model(scenario))).empty()) << name;
  }
}

// A sheet has a fold, and no lips.
TEST(Advice, WordsFitTheTissue) {
  const Scenario scenario = load_scenario({"flat", "flat.toml", sheet_table(60, 60, 10, 60) + R"([region.side]
y_um = [10, 25]
[contraction.apical]
region = "side"
stiffness_nN_per_um = 1
)"});
  const auto lines = lines_with("does not intersect the plane y = 0", advice(scenario, *make_model(scenario)));
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_SAYS(lines[0], "so the fold depth has no value; use [monitor.NAME] with quantity = \"depth\"");
}

using Overrides = std::vector<std::string>;

const std::string row =
    "[embryo]\nshape = \"block\"\nlength_um = 60\nwidth_um = 20\ncells = [3, 1, 1]\n[region.one]\nids = "
    "[1]\n[region.two]\nids = [2]\n[time]\nend_s = 60\n";
const std::string pull = "[contraction.c]\nregion = \"one\"\nstiffness_nN_per_um = 1\n";
const std::string sheet = "[embryo]\nshape = \"sheet\"\nlength_um = 30\nwidth_um = 30\ncell_count = 20\n";
const std::string division = "[division.cut]\nregion = \"all\"\nat_s = 5\n";

struct AdviceCase {
  std::string text;
  std::string phrase;
  std::vector<Overrides> remedies = {};  // empty: those that the message spells out
};

const std::vector<AdviceCase> cases = {
    {row,
     "no force acts",
     {{"contraction.c.region=all", "contraction.c.tension_mN_per_m=1"},
      {"cortex.c.region=all", "cortex.c.tension_mN_per_m=1"},
      {"pressure.p.region=all", "pressure.p.pressure_Pa=1"},
      {"growth.g.region=all", "growth.g.rate_per_h=1"},
      {"division.d.region=one", "division.d.at_s=5"}}},
    {row + "[contraction.c]\nregion = \"one\"\n",
     "contraction.c: has no effect",
     {{"contraction.c.stiffness_nN_per_um=1"}, {"contraction.c.preload_nN=1"}, {"contraction.c.tension_mN_per_m=1"}}},
    {row + "[division.cut]\nregion = \"one\"\nat_s = 90\n",
     "division.cut: the division occurs after the end",
     {{"division.cut.at_s=5"}, {"time.end_s=100"}}},
    {row + "[monitor.m]\nquantity = \"volume\"\nat_s = 90\n",
     "monitor.m: at_s is after the end",
     {{"monitor.m.at_s=5"}, {"time.end_s=100"}}},
    {row + pull + "[ablation.a]\nregion = \"one\"\nat_s = 90\n",
     "ablation.a: the ablation starts after the end",
     {{"ablation.a.at_s=5"}, {"time.end_s=100"}}},
    {row + pull + "[ablation.a]\nregion = \"two\"\nfaces = [\"basal\"]\nat_s = 5\n",
     "ablation.a: has no effect",
     {{"ablation.a.faces=[\"apical\"]", "ablation.a.region=one"}}},
    {row + pull + "program = { time_s = [0, 1], activity = [0, 0] }\n",
     "program is 0 at all times",
     {{"contraction.c.program.activity=[0, 1]"}}},
    {row + pull + "program = { time_s = [0, 90], activity = [0, 1] }\n",
     "program extends beyond",
     {{"contraction.c.program.time_s=[0, 30]"}, {"time.end_s=100"}}},
    {row + pull +
         "[cortex.x]\nregion = \"one\"\ntension_mN_per_m = 1\nprogram = { time_s = [0, 90], activity = [0, 1] }\n",
     "program extends beyond",
     {{"cortex.x.program.time_s=[0, 30]"}, {"time.end_s=100"}}},
    {row + pull, "time step is longer than the run", {{"time.step_s=30"}, {"time.end_s=400"}}},
    {row + pull + "profile = { shape = \"plateau\", full_cells = 2, fade_cells = 1, middle = 0 }\n",
     "profile is 0 in every cell",
     {{"contraction.c.profile.middle=1"}}},
    {row + pull + "[volume]\nmethod = \"projection\"\n",
     "time.integrator is \"backward-euler\", since \"bdf2\" does not support volume.method",
     {{"volume.method=coupled"}, {"time.integrator=backward-euler"}}},
    {row + pull + "[volume]\nmethod = \"projection\"\n", "the equilibrium of a projection", {{"time.step_s=5"}}},
    {row + pull + "[contraction.d]\nregion = \"two\"\nstiffness_nN_per_um = 1\n",
     "the fold is measured on the largest",
     {{"furrow.region=one"}, {"furrow.region=two"}}},
    {row + pull + "[furrow]\nregion = \"two\"\n", "apical surfaces contract in one", {{"furrow.region=one"}}},
    {"[embryo]\nshape = \"block\"\ncells = [3, 1, 1]\nelements_per_cell = [1, 1, 2]\n[elasticity]\nmodel = "
     "\"shape-memory\"\n",
     "shape memory acts on whole cells"},
    {sheet + "[elasticity]\nmodel = \"shape-memory\"\n", "shape memory acts on whole cells"},
    {row + "[elasticity]\nmodel = \"neo-hookean\"\n", "neo-hookean cells of one element"},
    {row + "[elasticity]\nmodel = \"neo-hookean\"\nrelaxation_s = 60\n", "neo-hookean cells of one element"},
    {row + "[elasticity]\nmodel = \"neo-hookean\"\n" + division, "neo-hookean cells of one element"},
    {sheet + "[contraction.c]\nregion = \"all\"\nstiffness_nN_per_um = 1\n[cortex.x]\nregion = "
             "\"all\"\ntension_mN_per_m = 1\n",
     "forces act in full from t = 0"},
};

std::vector<std::string> advice_with(const AdviceCase& one, const Overrides& overrides) {
  Overrides all;
  if (one.phrase.starts_with("time step is longer")) all.emplace_back("time.step_s=300");
  all.insert(all.end(), overrides.begin(), overrides.end());
  const Scenario scenario = scenario_of(one.text, all);
  std::vector<std::string> lines = advice(scenario, *make_model(scenario));
  std::erase_if(lines, [&](const std::string& line) { return line.find(one.phrase) == std::string::npos; });
  return lines;
}

TEST(AdviceRemedies, EachEndsItsMessage) {
  int tried = 0;
  for (const AdviceCase& one : cases) {
    SCOPED_TRACE(one.text);
    const std::vector<std::string> lines = advice_with(one, {});
    ASSERT_EQ(lines.size(), 1U);
    const auto remedies = one.remedies.empty() ? named_remedies(lines[0]) : one.remedies;
    EXPECT_FALSE(remedies.empty()) << lines[0];
    for (const Overrides& remedy : remedies) {
      EXPECT_EQ(advice_with(one, remedy), std::vector<std::string>()) << remedy.front();
      ++tried;
    }
  }
  EXPECT_EQ(tried, 37);
}

// Each shape has its own keys.
TEST(AdviceRemedies, CellsThatCannotDivideNameKeysOfTheirShape) {
  for (const auto& [text, remedy, overrides] :
       {std::tuple(std::string("[embryo]\nshape = \"block\"\ncells = [3, 1, 1]\nelements_per_cell = [2, 1, 1]\n"),
                   std::string("set embryo.elements_per_cell to [1, 1, 1]"),
                   Overrides{"embryo.elements_per_cell=[1, 1, 1]"}),
        {"[embryo]\nshape = \"block\"\ncells = [3, 1, 2]\n", "use one layer of cells", {"embryo.cells=[3, 1, 1]"}}}) {
    const ScenarioSource source{"test", "test.toml", text + division};
    try {
      (void)make_model(load_scenario(source));
      ADD_FAILURE() << text;
    } catch (const ScenarioError& error) {
      ASSERT_EQ(error.diagnostics().size(), 1U);
      EXPECT_EQ(error.diagnostics()[0].remedy, remedy);
    }
    EXPECT_NO_THROW((void)make_model(load_scenario(source, overrides))) << overrides.front();
  }
}

}  // namespace
