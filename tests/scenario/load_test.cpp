#include "scenario/load.hpp"

#include "support/scenarios.hpp"

namespace {

TEST(LoadScenario, FillsDefaults) {
  const Scenario scenario = scenario_of("");
  EXPECT_EQ(scenario.name, "test");
  EXPECT_EQ(scenario.embryo.shape, "pill");
  EXPECT_EQ(scenario.embryo.cells, (std::array<int, 3>{18, 9, 8}));
  EXPECT_FALSE(scenario.time.step_s.has_value());
  EXPECT_EQ(scenario.time.end_s, 3600);
  EXPECT_TRUE(scenario.vitelline.enabled);
  EXPECT_TRUE(scenario.regions.empty());
}

TEST(LoadScenario, ReadsEveryKindOfValue) {
  const Scenario scenario = scenario_of(R"(
title = "a \"b\""
[region.belly]
x_um = [-10, 20.5]
except = ["some"]
[region.some]
ids = [0, 7]
[contraction.a]
region = "belly"
diagonals = true
program = { time_min = [0, 1.5], activity = [0, 1] }
[hold.b]
region = "all"
directions = ["x", "z"]
[pressure.c]
region = "all"
pressure_Pa = -3
[output]
frame_every_min = 0.5
cells_csv = false
)");
  EXPECT_EQ(scenario.title, "a \"b\"");
  EXPECT_EQ(scenario.regions.at("belly").x_um, (Range{-10, 20.5}));
  EXPECT_EQ(scenario.regions.at("belly").except, std::vector<std::string>{"some"});
  EXPECT_EQ(scenario.regions.at("some").ids, (std::vector<int>{0, 7}));
  EXPECT_TRUE(scenario.contractions.at("a").diagonals);
  EXPECT_EQ(scenario.contractions.at("a").program.time_s, (std::vector<double>{0, 90}));
  EXPECT_EQ(scenario.holds.at("b").directions, (std::vector<std::string>{"x", "z"}));
  EXPECT_EQ(scenario.pressures.at("c").pressure_Pa, -3);
  EXPECT_EQ(scenario.output.frame_every_s, 30);
  EXPECT_EQ(scenario.output.cells_csv, false);
}

TEST(LoadScenario, NamesWhatIsWrongAndWhatWouldBeRight) {
  const std::string program = "[contraction.a]\nregion = \"all\"\n";
  const std::string block = "[embryo]\nshape = \"block\"\n";
  const WrongScenarios cases = {
      // Names.
      {"[embryo]\ndiametr_um = 3", "2: embryo.diametr_um: unknown key; use \"diameter_um\" (nearest match)"},
      {"[embryo]\n\nlength_mm = 3",
       "3: embryo.length_mm: unknown key; use \"length_um\" and convert the value to that unit"},
      {"[time]\nend_h = 1",
       "2: time.end_h: unknown key; use \"end_s\" or \"end_min\" and convert the value to that unit"},
      {"poisson_ratio = 0.3", "1: poisson_ratio: unknown key; move it to [elasticity]"},
      {"[regoin.a]\nface = \"ventral\"", "1: regoin: unknown table; use \"region\" (nearest match)"},
      {"[output]\nfrobnicate = 1",
       "2: output.frobnicate: unknown key; use one of: frame_every_s, frame_every_min, cells_csv"},
      {program + "program = { time_h = [0], activity = [1] }",
       "3: contraction.a.program.time_h: unknown key; use \"program.time_s\" or \"program.time_min\" and convert the "
       "value to that unit"},
      {"[region.\"a b\"]\nface = \"ventral\"",
       "1: region.a b: is not a valid name; use letters, digits, \"_\" and \"-\" only"},
      {"[region.all]\nface = \"ventral\"", "1: region.all: \"all\" is predefined as every cell; rename the region"},
      // Types, ranges and words.
      {"[embryo]\nlength_um = \"long\"",
       "2: embryo.length_um: \"long\" has the wrong type; set length_um to a number > 0"},
      {"[embryo]\nlength_um = 0", "2: embryo.length_um: 0 is out of range; set length_um to a number > 0"},
      {"[embryo]\nlength_um = nan", "2: embryo.length_um: nan is not a finite number; set length_um to a number > 0"},
      {"[embryo]\nelements_per_cell = [1, 17, 1]",
       "2: embryo.elements_per_cell: 17 is out of range; set elements_per_cell to 3 integers, 1 to 16"},
      {"[embryo]\ncells = [1, 2]",
       "2: embryo.cells: 2 values are given, but 3 are required; set cells to 3 integers, 1 to 100000"},
      {"[embryo]\ncells = [1, 2, 2.5]", "2: embryo.cells: 2.5 is not an integer; set cells to 3 integers, 1 to 100000"},
      {"[elasticity]\npoisson_ratio = 0.5",
       "2: elasticity.poisson_ratio: 0.5 is out of range; set poisson_ratio to a number > -1 and < 0.5"},
      {"[embryo]\nshape = \"pil\"",
       "2: embryo.shape: \"pil\" is unknown; set shape to one of: pill | sphere | slice | block | egg | points | sheet "
       "| surface | prisms | file (nearest match: \"pill\")"},
      {"[elasticity]\nattractor_preload_nN = 1",
       "2: elasticity.attractor_preload_nN: is not used with model \"corotational\"; remove it, or set "
       "elasticity.model to \"shape-memory\""},
      {"[time]\nstep_s = \"fast\"",
       "2: time.step_s: \"fast\" has the wrong type; set step_s to a number >= 1e-06 or \"adaptive\""},
      {"[stop]\nat_equilibrium = 1",
       "2: stop.at_equilibrium: 1 has the wrong type; set at_equilibrium to true or false"},
      {"format = 2", "1: format: 2 is out of range; set format to an integer, 1"},
      {"[region.a]\nx_um = [2, 1]", "2: region.a.x_um: low is above high; set x_um to [low, high]"},
      {"[region.a]\nids = []", "2: region.a.ids: the list is empty; set ids to a list of integers >= 0"},
      {"embryo = 3", "1: embryo: 3 is not a table; write a table"},
      {"[hold.a]\nregion = \"\"",
       "2: hold.a.region: the text is empty; set region to \"all\", or to the name of another region"},
      {"embryo.length_um = -1\nregion.a.face = \"top\"",
       "1: embryo.length_um: -1 is out of range; set length_um to a number > 0\n2: region.a.face: \"top\" is unknown; "
       "set face to one of: ventral | dorsal | left | right | anterior | posterior"},
      {"[[hold]]\nregion = \"all\"", "1: hold: a list is not a table; write a table"},
      {program + "program = 1",
       "3: contraction.a.program: 1 is not a table; write a table of time_s, time_min, activity"},
      // The embryo as a whole.
      {"[embryo]\nlength_um = 200",
       "2: embryo.length_um: 200 is less than the diameter, 280; set length_um to at least diameter_um"},
      {"[embryo]\ncell_height_um = 140",
       "2: embryo.cell_height_um: 140 leaves no room inside the embryo; set cell_height_um below half of diameter_um, "
       "140"},
      {"[embryo]\nshape = \"sphere\"\nlength_um = 460",
       "3: embryo.length_um: is not used with shape \"sphere\"; remove length_um, or set shape to pill or slice or "
       "block or egg or sheet"},
      {"[embryo]\nwidth_um = 1",
       "2: embryo.width_um: is not used with shape \"pill\"; remove width_um, or set shape to block or sheet"},
      {"[embryo]\nshape = \"file\"", "1: embryo.file: is missing; set file to the mesh file for shape \"file\""},
      {block + "cells = [100000, 100000, 100000]\nelements_per_cell = [8, 8, 8]",
       "3: embryo.cells: requires 512000000000000000 elements, more than the limit of 20000000; reduce cells or "
       "elements_per_cell"},
      {"[embryo]\ncells = [2000, 1000, 1000]\nelements_per_cell = [1, 2, 2]",
       "2: embryo.cells: requires 40000000 elements, more than the limit of 20000000; reduce cells or "
       "elements_per_cell"},
      {block + "[vitelline]\nenabled = true",
       "4: vitelline.enabled: a vitelline membrane requires a closed embryo, but a block is open; set enabled to "
       "false"},
      {"[dynamics]\nsurface_drag_Pa_s_per_um = 0",
       "2: dynamics.surface_drag_Pa_s_per_um: drag and density are both 0; set surface_drag_Pa_s_per_um or "
       "density_kg_per_m3 above 0"},
      // Times and programs.
      {"[time]\nend_min = 1\nend_s = 60",
       "3: time.end_s: conflicts with time.end_min, which is also set; remove one of them"},
      {"[time]\nfirst_step_s = 61",
       "2: time.first_step_s: 61 is above max_step_s, 30; set first_step_s to at most max_step_s"},
      {"[time]\nintegrator = \"bdf2\"\n[dynamics]\ndensity_kg_per_m3 = 1",
       "2: time.integrator: \"bdf2\" does not support dynamics.density_kg_per_m3 above 0; set integrator to "
       "\"backward-euler\""},
      {"[time]\nintegrator = \"bdf2\"\n[volume]\nmethod = \"projection\"",
       "2: time.integrator: \"bdf2\" does not support volume.method = \"projection\"; set integrator to "
       "\"backward-euler\""},
      {"[time]\nintegrator = \"bdf2\"\nscheme = \"linearly-implicit\"\n[volume]\nmethod = \"none\"",
       "2: time.integrator: \"bdf2\" does not support time.scheme = \"linearly-implicit\"; set integrator to "
       "\"backward-euler\""},
      {program + "program = { time_s = [0, 1], activity = [1] }",
       "3: contraction.a.program.activity: has length 1 for 2 times; set activity to as many values as times"},
      {program + "program = { activity = [1] }",
       "3: contraction.a.program.time_s: is missing; set time_s or time_min along with activity"},
      {program + "program = { time_s = [1] }",
       "3: contraction.a.program.activity: is missing; set activity to as many values as times"},
      {program + "program = { time_min = [0, 1, 0.5], activity = [1, 1, 1] }",
       "3: contraction.a.program.time_min: the times do not increase; list times in increasing order; repeat a time "
       "once to mark a jump"},
      {program + "program = { time_s = [0], activity = [-1] }",
       "3: contraction.a.program.activity: -1 is out of range; set activity to a list of numbers >= 0"},
      {program + "profile = { sigma_um = 30 }",
       "3: contraction.a.profile.shape: is missing; set shape to one of: constant | linear | gaussian | plateau | "
       "table | array"},
      {program + "profile = { shape = \"gaussian\" }",
       "3: contraction.a.profile.sigma_um: is missing; set sigma_um or sigma_cells to a number > 0"},
      {program + "profile = { shape = \"linear\", edge = 0.5 }",
       "3: contraction.a.profile.half_width_um: is missing; set half_width_um to the distance at which the factor "
       "reaches edge, a number > 0"},
      {program + "profile = { shape = \"linear\", half_width_um = 50, sigma_um = 3 }",
       "3: contraction.a.profile.sigma_um: is not used with shape \"linear\"; remove it, or set shape to \"gaussian\""},
      {program + "profile = { shape = \"constant\", edge = 0.5 }",
       "3: contraction.a.profile.edge: is not used with a constant profile; remove it, or set another shape or a "
       "taper"},
      {program + "delay = { from = \"ends\" }",
       "3: contraction.a.delay.speed_um_per_s: is missing; set speed_um_per_s to a number > 0 or \"none\""},
      {program + "delay = { from = \"ends\", speed_um_per_s = \"none\" }",
       "3: contraction.a.delay.from: is not used with speed \"none\"; remove it, or set speed_um_per_s"},
      {program + "variation = { sead = 2 }",
       "3: contraction.a.variation.sead: unknown key; use \"variation.seed\" (nearest match)"},
      // Regions.
      {"[contraction.a]\nstiffness_nN_per_um = 1",
       "1: contraction.a.region: is missing; set region to \"all\", or to the name of another region"},
      {"[region.furrow]\nface = \"ventral\"\n[contraction.a]\nregion = \"furow\"",
       "4: contraction.a.region: region \"furow\" does not exist; use \"furrow\" (nearest match)"},
      {"[hold.a]\nregion = \"b\"", "2: hold.a.region: region \"b\" does not exist; use one of: all"},
      {"[pressure.a]\npressure_Pa = 1\nregion = \"b\"",
       "3: pressure.a.region: region \"b\" does not exist; use one of: all"},
      {"[furrow]\nregion = \"b\"", "2: furrow.region: region \"b\" does not exist; use one of: all"},
      {"[region.a]\nunion = [\"all\", \"b\"]", "2: region.a.union: region \"b\" does not exist; use one of: all, a"},
      {"[region.a]\nintersect = [\"b\"]", "2: region.a.intersect: region \"b\" does not exist; use one of: all, a"},
      {"[region.a]\nexcept = [\"b\"]", "2: region.a.except: region \"b\" does not exist; use one of: all, a"},
      {"[region.a]\nunion = [\"b\"]\n[region.b]\nexcept = [\"a\"]",
       "1: region.a: refers to itself: a > b > a; remove one of these references"},
      {"[region.a]",
       "1: region.a: has no selector; set face, ids, array, angle_deg, length_percent, x_um, y_um, z_um, rows, "
       "neighbours_of, union, intersect or except"},
      {"[region.a]\nids = [1]\ncells_across = 3", "3: region.a.cells_across: is not used without face; set face"},
      {"[region.a]\nface = \"ventral\"\ncells_along = 13",
       "3: region.a.cells_along: 13 cells cannot be centred on 18; set cells_along to 12 or 14 (both numbers odd, or "
       "both even)"},
      {"[region.a]\nface = \"left\"\ncells_across = 9",
       "3: region.a.cells_across: 9 exceeds the 8 cells of the face in this direction; set cells_across to at most 8"},
      {"[region.a]\nface = \"posterior\"\ncells_along = 18",
       "3: region.a.cells_along: 18 exceeds the 9 cells of the face in this direction; set cells_along to at most 9"},
      {"[region.a]\nids = [756]", "2: region.a.ids: cell 756 does not exist; set ids to numbers from 0 to 755"},
      // Expectations.
      {"[expect]\nfurrow_depth_um = 28.89",
       "2: expect.furrow_depth_um: 28.89 has no tolerance; write { value = ..., within_percent = ... } or { value = "
       "..., within = ... }"},
      {"[expect]\nfurrow_depth_um = { value = 1 }",
       "2: expect.furrow_depth_um: has no tolerance; set within or within_percent"},
      {"[expect]\nfurrow_depth_um = { within = 1 }",
       "2: expect.furrow_depth_um.value: is missing; set value to a number"},
      {"[expect]\nfurrow_dept_um = { value = 1, within = 1 }",
       "2: expect.furrow_dept_um: unknown output variable; use \"furrow_depth_um\" (nearest match)"},
      {"[expect]\ncells = { value = 1, within = 1, within_percent = 1 }",
       "2: expect.cells.within_percent: conflicts with expect.cells.within, which is also set; remove one of them"},
      // Bases.
      {"base = \"drosophla\"",
       "1: base: \"drosophla\" is neither a built-in scenario nor a file; use \"drosophila\" (nearest match); set base "
       "to a built-in name or a path relative to this file"},
  };
  expect_errors(cases, load_errors);
}

TEST(LoadScenario, ReportsSyntaxErrorsWithTheirLine) {
  const std::string errors = load_errors("format = 1\n[embryo\nlength_um = 3\n");
  EXPECT_TRUE(errors.starts_with("test.toml:2: ")) << errors;
}

TEST(LoadScenario, ReportsAllErrorsAtOnceInOrderOfLines) {
  const std::string errors =
      load_errors("[time]\nend_s = -1\n[contraction.a]\nregion = \"nowhere\"\n[embryo]\nlength_um = true\nhue = 1\n",
                  {"time.max_step_s=0"});
  EXPECT_EQ(
      errors,
      "test.toml:2: time.end_s: -1 is out of range; set end_s to a number > 0\ntest.toml:4: contraction.a.region: "
      "region \"nowhere\" does not exist; use one of: all\ntest.toml:6: embryo.length_um: true has the wrong type; set "
      "length_um to a number > 0\ntest.toml:7: embryo.hue: unknown key; use one of: shape, length_um, diameter_um, "
      "width_um, cell_height_um, cells, elements_per_cell, cell_count, seed, curvature_per_um, rim, periodic, "
      "belly_sag_um, back_sag_um, elements, least_edge_ratio, layers, points_depth_um, scale, rotate_deg, centre, "
      "keep, label_array, mend, cell_height_array, mirror, file, cell_arrays, apical_array, axes\n--set: "
      "time.max_step_s: 0 is out of range; set max_step_s to a number > 0");
}

TEST(LoadScenario, OneMistakeIsOneError) {
  // Unknown key meant as region, unknown table meant to define it, region that was not read.
  EXPECT_EQ(load_errors("[contraction.a]\nregoin = \"all\""),
            "test.toml:2: contraction.a.regoin: unknown key; use \"region\" (nearest match)");
  EXPECT_EQ(load_errors("[regions.a]\nface = \"left\"\n[hold.a]\nregion = \"a\""),
            "test.toml:1: regions: unknown table; use \"region\" (nearest match)");
  EXPECT_EQ(load_errors("[region]\na = 1\n[hold.a]\nregion = \"a\""),
            "test.toml:2: region.a: 1 is not a table; write a table");
}

TEST(LoadScenario, AcceptsStripsThatCanBeCentred) {
  for (const std::string strip :
       {"face = \"ventral\"\ncells_along = 14\ncells_across = 5", "face = \"right\"\ncells_along = 2\ncells_across = 8",
        "face = \"anterior\"\ncells_along = 9\ncells_across = 2"})
    EXPECT_EQ(load_errors("[region.a]\n" + strip), "") << strip;
}

TEST(LoadScenario, SettlesDefaultsThatDependOnTheShape) {
  EXPECT_FALSE(scenario_of("[embryo]\nshape = \"block\"").vitelline.enabled);
  EXPECT_EQ(scenario_of("[embryo]\nshape = \"sphere\"\ndiameter_um = 300").embryo.length_um, 300);
  const auto here = std::filesystem::current_path();
  EXPECT_EQ(load_scenario({"a", "in/a.toml", "[embryo]\nshape = \"file\"\nfile = \"../b.vtu\""}).embryo.file,
            (here / "b.vtu").string());
}

// Inherited attractor keys are dropped with their model, like an inherited length with a pill.
TEST(LoadScenario, SettlesTheAttractorByTheElasticModel) {
  const std::string springs = "[elasticity]\nmodel = \"shape-memory\"\nattractor_stiffness_nN_per_um = 7\n";
  EXPECT_EQ(scenario_of(springs).elasticity.attractor_stiffness_nN_per_um, 7);
  EXPECT_EQ(scenario_of(springs, {"elasticity.attractor_stiffness_nN_per_um=derived"})
                .elasticity.attractor_stiffness_nN_per_um,
            std::nullopt);
  EXPECT_EQ(scenario_of(springs, {"elasticity.model=corotational"}).elasticity.attractor_stiffness_nN_per_um,
            std::nullopt);
}

TEST(LoadScenario, SettlesTheDefaultsOfPatterns) {
  const std::string start = "[contraction.a]\nregion = \"all\"\n";
  const ContractionInput none = scenario_of(start).contractions.at("a");
  EXPECT_EQ(none.profile.shape, "");
  EXPECT_EQ(none.delay.speed_um_per_s, std::nullopt);
  EXPECT_EQ(none.variation.spread, 0);
  const std::string given =
      start + "profile = { shape = \"linear\", half_width_um = 50 }\ndelay = { speed_um_per_s = 2 }";
  const ContractionInput some = scenario_of(given).contractions.at("a");
  EXPECT_EQ(some.profile.axis, "across");
  EXPECT_EQ(some.profile.edge, std::nullopt);
  EXPECT_EQ(some.delay.axis, "along");
  EXPECT_EQ(some.delay.from, "middle");
  // Keys of the shape and the wave are dropped with them.
  const ContractionInput other =
      scenario_of(given, {"contraction.a.profile.shape=gaussian", "contraction.a.profile.sigma_um=30",
                          "contraction.a.delay.speed_um_per_s=none"})
          .contractions.at("a");
  EXPECT_EQ(other.profile.half_width_um, std::nullopt);
  EXPECT_EQ(other.profile.sigma_um, 30);
  EXPECT_EQ(other.delay.axis, "");
}

TEST(LoadScenario, OverridesGoLast) {
  const std::string text = "[contraction.a]\nregion = \"all\"\n[time]\nend_s = 5\nstep_s = 1\n";
  const Scenario scenario =
      scenario_of(text, {"time.end_min=2", "time.step_s = adaptive", "contraction.a.edges=basal",
                         "contraction.a.program.time_s=[0, 1]", "contraction.a.program.activity=[0, 1]",
                         "time.max_step_s=7", "time.max_step_s=8", "title=\"two words\""});
  EXPECT_EQ(scenario.time.end_s, 120);
  EXPECT_FALSE(scenario.time.step_s.has_value());
  EXPECT_EQ(scenario.contractions.at("a").faces, "basal");
  EXPECT_EQ(scenario.contractions.at("a").program.time_s.size(), 2u);
  EXPECT_EQ(scenario.time.max_step_s, 8);
  EXPECT_EQ(scenario.title, "two words");
}

// A shell removes the quotes of a text.
TEST(LoadScenario, OverridesOfTextsNeedNoQuotes) {
  const std::string surface = "[embryo]\nshape = \"surface\"\n";
  for (const std::string name :
       {"off_1e+05.obj", "two words.obj", "a=b (1).obj", "1e5", "2024-01-01", "x#1.obj", "true"})
    EXPECT_TRUE(scenario_of(surface, {"embryo.file=" + name}).embryo.file.ends_with("/" + name)) << name;
  EXPECT_EQ(scenario_of("", {"title=50 % less"}).title, "50 % less");
  EXPECT_EQ(load_errors("", {"embryo.shape=a ball"}).find("--set: embryo.shape: \"a ball\" is unknown"), 0U);
}

TEST(LoadScenario, ReportsWrongOverrides) {
  const auto not_understood = [](const std::string& key) {
    return "--set: " + key +
           ": cannot be parsed; write dotted.key=value with a TOML value: a number with a decimal point and no unit, "
           "or a word";
  };
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"time.end_s", not_understood("time.end_s")},
      {"time.end_s=5,5", not_understood("time.end_s")},
      {"time.end_s=5 s", not_understood("time.end_s")},
      {"time.end_s=", not_understood("time.end_s")},
      {"title=\"two words", not_understood("title")},
      {"title=1\nformat=2", not_understood("title")},
      {"time.ends=3", "--set: time.ends: unknown key; use \"end_s\" (nearest match)"},
      {"base=drosophila", "--set: base: base cannot be set on the command line; write base in the scenario's file"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(load_errors("", {text}), message) << text;
}

TEST(FindScenario, SaysWhichNameIsNear) {
  EXPECT_EQ(error_of<UsageError>([] { return find_scenario("drosofila"); }),
            "\"drosofila\" is neither a built-in scenario nor a file; use \"drosophila\" (nearest match)");
  EXPECT_THROW(find_scenario("/"), FileError);
}

}  // namespace
