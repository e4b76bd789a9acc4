// Keys of [cortex.NAME], and of the interior of cells: moduli, flow.
#include "scenario/advice.hpp"
#include "support/forces_of_cells.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"

namespace {

const std::string cortex = "[cortex.a]\nregion = \"all\"\n";
const std::string cable = "[contraction.a]\nregion = \"all\"\npreload_nN = 1\n";

TEST(CortexKeys, SayWhatWouldBeRight) {
  const WrongScenarios cases = {
      {cortex, "1: cortex.a: has no effect; set tension_mN_per_m, stiffness_mN_per_m or crowding_mN_per_m"},
      {cortex + "stiffness_mN_per_m = 1\nsaturation_ratio = 0.2",
       "4: cortex.a.saturation_ratio: is not used without tension_mN_per_m; remove it, or set tension_mN_per_m"},
      {cortex + "tension_mN_per_m = 1\ncompression_ratio = 0.1",
       "4: cortex.a.compression_ratio: is not used without stiffness_mN_per_m; remove it, or set stiffness_mN_per_m"},
      {cortex + "stiffness_mN_per_m = 1\nstiffness_program = { time_min = [0, 1], activity = [1] }",
       "4: cortex.a.stiffness_program.activity: has length 1 for 2 times; set activity to as many values as times"},
      {"[cortex.apical]\nregion = \"all\"\ntension_mN_per_m = 1\n[cortex.apicl]\ntension_mN_per_m = 2",
       "4: cortex.apicl.region: is missing; set region to \"all\", or to the name of another region, or rename the "
       "table to cortex.apical (nearest "
       "match)"},
      {"[cortex.a]\nregion = \"mesoderm\"\ntension_mN_per_m = 1",
       "2: cortex.a.region: region \"mesoderm\" does not exist; use one of: all"},
      {cortex + "tension_mN_per_m = 1\nprofile = { shape = \"gaussian\", sigma_um = 3, sigma_cells = 2 }",
       "4: cortex.a.profile.sigma_um: conflicts with cortex.a.profile.sigma_cells, which is also set; remove one of "
       "them"},
      {cortex + "tension_mN_per_m = 1\nprofile = { shape = \"plateau\", full_cells = 3 }",
       "4: cortex.a.profile.fade_cells: is missing; set fade_cells to the width of the taper in cells (0: none)"},
      {cortex +
           "tension_mN_per_m = 1\nprofile = { shape = \"plateau\", full_cells = 3, fade_cells = 1, about = \"belly\" }",
       "4: cortex.a.profile.about: region \"belly\" does not exist; use one of: all"},
      {cortex + "tension_mN_per_m = 1\ntrigger = { below = 0.3 }",
       "4: cortex.a.trigger.measure: is missing; set measure to one of: apical_area_ratio | basal_area_ratio | "
       "height_ratio | apical_stretch | stress_Pa; or set signal"},
      {"elasticity.model = \"shape-memory\"\n" + cortex +
           "tension_mN_per_m = 1\nfollow = { measure = \"stress_Pa\", from = 0, to = 10 }",
       "5: cortex.a.follow.measure: model \"shape-memory\" has no stress; set elasticity.model to \"corotational\", or "
       "measure to \"apical_stretch\""},
      {cortex +
           "stiffness_mN_per_m = 1\ndirection = { axis = \"along\", weakest = 0.5 }\n[cortex.b]\nregion = \"all\"\n"
           "tension_mN_per_m = 1\ntrigger = { measure = \"stress_Pa\", above = 10 }",
       "8: cortex.b.trigger.measure: stress_Pa has no passive fibres, such as cortex.a; put stiffness and crowding of "
       "cortex.a into a table without direction"},
      {cortex + "tension_mN_per_m = 1\nfollow = { of = \"neighbours\" }",
       "4: cortex.a.follow.measure: is missing; set measure to one of: apical_area_ratio | basal_area_ratio | "
       "height_ratio | apical_stretch | stress_Pa; or set signal"},
      {cortex + "tension_mN_per_m = 1\ntrigger = { measure = \"height_ratio\" }",
       "4: cortex.a.trigger.below: is missing; set either below or above"},
      {cortex + "tension_mN_per_m = 1\nfollow = { measure = \"height_ratio\", from = 1, to = 1 }",
       "4: cortex.a.follow.to: equals `from`; set `to` to a different value"},
      {cortex + "tension_mN_per_m = 1\nfollow = { measure = \"height_ratio\", from = 1, to = 2 }\ntrigger = { measure "
                "= \"height_ratio\", below = 1 }",
       "4: cortex.a.follow: conflicts with `trigger`; remove one of them"},
      {cortex +
           "tension_mN_per_m = 1\ndelay = { speed_um_per_s = 1 }\ntrigger = { measure = \"height_ratio\", below = 1 }",
       "5: cortex.a.trigger: conflicts with `delay`, which activates cells at prescribed times; remove one of them"},
      {cortex + "tension_mN_per_m = 1\nprofile = { full_length_um = 300 }",
       "4: cortex.a.profile.fade_um: is missing; set both full_length_um and fade_um"},
      {cable + "border = \"all\"\nedges = \"lateral\"",
       "5: contraction.a.edges: conflicts with `border`, which makes a cable; set edges to \"apical\" or \"basal\""},
      {cable + "border = \"all\"\ndiagonals = true",
       "5: contraction.a.diagonals: conflicts with `border`, which makes a cable; remove one of them"},
      {cable + "border = \"all\"\ntension_mN_per_m = 1",
       "5: contraction.a.tension_mN_per_m: conflicts with `border`, which makes a cable; set the tension of the cable "
       "as preload_nN"},
      {cable + "border = \"mesoderm\"", "4: contraction.a.border: region \"mesoderm\" does not exist; use one of: all"},
      {"[enclosed.yolk]\nvolume = \"compliant\"\n[vitelline]\ngap_um = 1",
       "1: enclosed.yolk.bulk_modulus_Pa: is missing; set bulk_modulus_Pa to a number > 0"},
      {"[enclosed.yolk]\nbulk_modulus_Pa = 10\n[vitelline]\ngap_um = 1",
       "2: enclosed.yolk.bulk_modulus_Pa: is not used with volume \"held\"; remove bulk_modulus_Pa, or set volume to "
       "\"compliant\""},
      {"[enclosed.yolk]\nvolume = \"held\"",
       "2: enclosed.yolk.volume: no cell can leave the vitelline membrane, since cell and enclosed volumes are fixed "
       "and the gap is 0; set vitelline.gap_um, for example to 0.5, or volume to \"compliant\""},
      {"[embryo]\nshape = \"slice\"\n[division.a]\nregion = \"all\"\nat_s = 5",
       "2: embryo.shape: cells of a slice cannot divide, since its cross-sections must stay alike; set shape to "
       "\"pill\", or remove [division]"},
      {"[embryo]\nshape = \"block\"\n[enclosed.yolk]\nvolume = \"held\"",
       "3: enclosed.yolk: a block encloses no volume; remove the table, or set embryo.shape to \"pill\" or \"sphere\""},
      {"[enclosed.yolk]\nvolume = \"held\"\n[volume]\nmethod = \"projection\"",
       "2: enclosed.yolk.volume: the paper's algorithm does not support a held volume; set volume to \"compliant\", or "
       "set time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
      {"[enclosed.a]\nvolume = \"held\"\n[enclosed.b]\nsurface = \"basal\"\n[vitelline]\ngap_um = 1",
       "4: enclosed.b.surface: another table already constrains this volume; remove one of the two tables"},
      {"[self_contact]\nsurface = \"apical\"\ndistance_um = 10",
       "1: self_contact.search_um: 6 is below twice distance_um; set search_um to several times distance_um"},
      {"[self_contact]\nfriction = 0.3",
       "2: self_contact.friction: is not used with surface \"none\"; remove friction, or set surface, for example to "
       "\"apical\""},
      {"[vitelline]\nenabled = false\ndrag_Pa_s_per_um = 5",
       "3: vitelline.drag_Pa_s_per_um: is not used without a vitelline membrane; remove drag_Pa_s_per_um, or set "
       "enabled to true"},
      {"[embryo]\nshape = \"block\"\n[vitelline]\ndrag_Pa_s_per_um = 5",
       "4: vitelline.drag_Pa_s_per_um: is not used without a vitelline membrane; remove drag_Pa_s_per_um"},
      {"[vitelline]\ndrag_Pa_s_per_um = 5\n[volume]\nmethod = \"projection\"",
       "2: vitelline.drag_Pa_s_per_um: the paper's algorithm does not support drag along the membrane; remove "
       "drag_Pa_s_per_um, or set time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
      {"[self_contact]\nsurface = \"apical\"\n[volume]\nmethod = \"projection\"",
       "2: self_contact.surface: the paper's algorithm does not support self-contact; set surface to \"none\", or set "
       "time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
  };
  expect_errors(cases, load_errors);
}

// The middle of three cell layers has neither apical nor basal faces.
TEST(CortexKeys, FacesThatARegionDoesNotHave) {
  const std::string block =
      "[embryo]\nshape = \"block\"\ncells = [2, 2, 3]\n[region.inner]\nz_um = [-10, 10]\n[region.lower]\nz_um = [-100, "
      "-10]\n";
  for (const auto& [table, problem] : {std::pair("[cortex.a]\ntension_mN_per_m = 1\nregion = \"inner\"",
                                                 "test.toml:10: cortex.a.region: no cell of this region has an apical "
                                                 "face; set region to cells with this face, or change faces"),
                                       {"[contraction.a]\nstiffness_nN_per_um = 1\nregion = \"lower\"",
                                        "test.toml:10: contraction.a.region: no cell of this region has an apical "
                                        "face; set region to cells with this face, or change edges"},
                                       {"[pressure.a]\nface = \"basal\"\nregion = \"inner\"\npressure_Pa = 1",
                                        "test.toml:10: pressure.a.region: no cell of this region has a basal face; set "
                                        "region to cells with this face, or change face"}})
    EXPECT_EQ(model_errors(block + table), problem);
}

// A scenario with a fixed yolk volume may inherit the bulk modulus of its base.
TEST(CortexKeys, AHeldYolkLeavesWhatItsBaseSaysOfACompliantOne) {
  EXPECT_NO_THROW(scenario_of("base = \"furrow-slice\"\n[enclosed.yolk]\nvolume = \"held\""));
}

// Invaginating ventral side, with all laws of a closing furrow.
Scenario furrow_of_cortices() {
  const std::string yolk = "[enclosed.yolk]\nvolume = \"compliant\"\nbulk_modulus_Pa = 50000\n";
  return load_scenario({"furrow", "furrow.toml", small_furrow + yolk});
}

// The region of the active apical cortex is where the furrow is measured.
TEST(CortexKeys, ASmallFurrowOfCorticesFolds) {
  const Scenario scenario = furrow_of_cortices();
  Simulation simulation(scenario);
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  const Observation measures = simulation.measures();
  EXPECT_GT(*measures["furrow_depth_um"], 2);
  EXPECT_NEAR(*measures["lumen_volume_ratio"], 1, 1e-3);
  EXPECT_LE(*measures["max_volume_error"], 1e-9);
  EXPECT_EQ(contracting_regions(scenario, simulation.model().tissue), std::vector<std::string>{"belly"});
}

// A tension set to 0 switches the cortex off; its program and profile are no error.
TEST(CortexKeys, OneThatIsGivenAsNothingIsOff) {
  const Simulation without(load_scenario(find_scenario("furrow-slice"), {"cortex.shortening.tension_mN_per_m=0"}));
  EXPECT_EQ(Simulation(load_scenario(find_scenario("furrow-slice"))).model().laws.size(),
            without.model().laws.size() + 1);
}

// Forces exerted by a part of the tissue exclude yolk pressure and contact.
TEST(CortexKeys, ForcesOfAPartLeaveOutWhatIsNotOfCells) {
  Scenario scenario = furrow_of_cortices();
  scenario.cortices.clear();
  scenario.elasticity.corner_barrier_Pa = 0;
  const Simulation simulation(scenario);
  State state = simulation.state();
  for (Vec3& x : state.positions) x *= 0.99;  // at rest but for the yolk's pressure
  const Tissue& tissue = simulation.model().tissue;
  const Vectors belly = forces_of_cells(simulation.model(), state, tissue.regions.at("belly"));
  Model alone(tissue);
  for (const auto& law : simulation.model().laws)
    if (law->name() != "enclosed volume" && law->name() != "self-contact") alone.laws.push_back(law->clone());
  State of_alone = rest_state(alone);
  of_alone.positions = state.positions;
  EXPECT_EQ(belly, forces_of_cells(alone, of_alone, tissue.regions.at("belly")));
}

// Checkpoints include relaxing stress-free areas and contact pairs.
TEST(CortexKeys, ARunGoesOnToTheSameBits) {
  Scenario scenario = furrow_of_cortices();
  scenario.self_contact.friction = 0.3;
  scenario.vitelline.drag_Pa_s_per_um = 50;
  Simulation whole(scenario);
  std::optional<RunMemory> kept;
  while (whole.step())
    if (whole.steps() == 12) kept = whole.memory();
  ASSERT_TRUE(kept);
  Simulation rest(scenario);
  go_on_by_bytes(rest, *kept);
  EXPECT_EQ(rest.run(), whole.status());
  EXPECT_EQ(rest.steps(), whole.steps());
  expect_same(rest.state(), whole.state());
  std::size_t remembered = 0;
  for (const auto& internal : whole.state().internals) remembered += internal.size();
  EXPECT_GT(remembered, 0u);
}

TEST(InteriorKeys, ModuliByRegionSayWhatWouldBeRight) {
  const std::string soft = "[elasticity.soft]\nregion = \"all\"\n";
  const std::string two =
      "[region.left]\nface = \"ventral\"\n[region.belly]\nface = \"ventral\"\ncells_across = "
      "1\n[elasticity.soft]\nregion = \"left\"\nyoung_modulus_Pa = 5\n[elasticity.stiff]\nregion = "
      "\"belly\"\nyoung_modulus_Pa = 50\n";
  const WrongScenarios cases = {
      {soft,
       "1: elasticity.soft: has no effect; set young_modulus_Pa, poisson_ratio, relaxation_min, profile or variation"},
      {"[elasticity.soft]\nyoung_modulus_Pa = 5",
       "1: elasticity.soft.region: is missing; set region to \"all\", or to the name of another region"},
      {"[elasticity]\nmodel = \"neo-hookean\"\n" + soft + "poisson_ratio = -0.2",
       "5: elasticity.soft.poisson_ratio: -0.2 is below 0, the minimum with model \"neo-hookean\"; set poisson_ratio "
       "to a number >= 0, or model to \"corotational\""},
      {soft + "young_modulus_Pa = 5\nheight_percent = [80, 100]",
       "4: elasticity.soft.height_percent: no element of the region has its centre in this part of the height; widen "
       "height_percent, or increase embryo.elements_per_cell through the height"},
      {"[embryo]\nelements_per_cell = [1, 1, 3]\n[region.belly]\nface = \"ventral\"\n" + soft +
           "young_modulus_Pa = 5\nheight_percent = [60, 100]\n[elasticity.apex]\nregion = \"belly\"\nheight_percent = "
           "[80, 100]\npoisson_ratio = 0.3",
       "5: elasticity.soft: overlaps elasticity.apex in the same layer of cell 0 at (-154.4, -67.53, -74.13) um; set "
       "height_percent to disjoint ranges, or use disjoint regions"},
      {soft + "young_modulus_Pa = 5\nheight_percent = [80, 10]",
       "4: elasticity.soft.height_percent: low is above high; set height_percent to [low, high], 0 to 100"},
      {soft + "profile = { shape = \"linear\", half_width_um = 20 }",
       "3: elasticity.soft.profile: the modulus of cell 0 at (-154.4, -67.53, -74.13) um would be 0; set profile.edge "
       "or profile.factor above 0"},
      {"[elasticity.soft]\nregion = \"belly\"\nyoung_modulus_Pa = 5",
       "2: elasticity.soft.region: region \"belly\" does not exist; use one of: all"},
      {"[elasticity]\nmodel = \"shape-memory\"\n" + soft + "young_modulus_Pa = 5",
       "3: elasticity.soft: model \"shape-memory\" does not support regions; remove the table, or set elasticity.model "
       "to \"corotational\" or \"neo-hookean\""},
      {two,
       "9: elasticity.stiff: overlaps elasticity.soft in cell 72 at (-167.4, 0, -90.53) um; use disjoint regions, for "
       "example with `except`"},
  };
  expect_errors(cases, model_errors);
}

TEST(InteriorKeys, NeoHookeanAndFlowSayWhatWouldBeRight) {
  const std::string neo = "[elasticity]\nmodel = \"neo-hookean\"\n";
  const std::string soft = "[elasticity.soft]\nregion = \"all\"\n";
  const WrongScenarios cases = {
      {"[elasticity]\nrelaxation_min = 6",
       "2: elasticity.relaxation_min: is not used with model \"corotational\"; remove it, or set elasticity.model to "
       "\"neo-hookean\""},
      {"[elasticity]\nmodel = \"shape-memory\"\nrelaxation_s = 6",
       "3: elasticity.relaxation_s: is not used with model \"shape-memory\"; remove it, or set elasticity.model to "
       "\"neo-hookean\""},
      {neo + "attractor_preload_nN = 1",
       "3: elasticity.attractor_preload_nN: is not used with model \"neo-hookean\"; remove it, or set elasticity.model "
       "to \"shape-memory\""},
      {neo + "poisson_ratio = -0.2",
       "3: elasticity.poisson_ratio: -0.2 is below 0, the minimum with model \"neo-hookean\"; set poisson_ratio to a "
       "number >= 0, or model to \"corotational\""},
      {neo + "[dynamics]\nshear_viscosity_Pa_s = 10",
       "4: dynamics.shear_viscosity_Pa_s: model \"neo-hookean\" does not support shear viscosity; set it to 0 and use "
       "elasticity.relaxation_min, or set elasticity.model to \"corotational\""},
      {soft + "relaxation_min = 6",
       "3: elasticity.soft.relaxation_min: is not used with model \"corotational\"; remove it, or set elasticity.model "
       "to \"neo-hookean\""},
      {neo + soft + "relaxation_min = \"none\"",
       "5: elasticity.soft.relaxation_min: \"none\" has the wrong type; set relaxation_min to a number > 0"},
  };
  expect_errors(cases, model_errors);
}

// Relaxation of one region only, and the dilatation law of neo-Hookean cells.
TEST(InteriorKeys, WhatTheyMakeOfTheModel) {
  const auto laws = [](const std::string& more) {
    const auto model = make_model(load_scenario(pulled_block(more)));
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

TEST(CableKeys, NeedABorder) {
  const std::string half = block_table(20, 20, 10, "2, 2, 1") + "mirror = [\"y\"]\n";
  expect_errors(
      {{block_table(20, 20, 10, "2, 2, 1") + "[region.one]\nids = [0]\n[region.far]\nids = [3]\n" +
            "[contraction.a]\nregion = \"one\"\npreload_nN = 1\nborder = \"far\"",
        "14: contraction.a.border: region \"one\" has no edge there; set it to a region beside it, or to \"all\""}},
      model_errors);
  expect_errors(
      {{half + "[region.one]\nids = [0]\n[contraction.a]\nregion = \"all\"\npreload_nN = 1\nborder = \"one\"",
        "13: contraction.a.border: region \"all\" has no edge there; set it to a region beside it, or to \"all\""}},
      model_errors);
  expect_errors(
      {{half + "[region.left]\nx_um = [-100, 0]\n[region.one]\nids = [1]\n[contraction.a]\nregion = \"left\"\n"
               "preload_nN = 1\nborder = \"one\"",
        "15: contraction.a.border: region \"one\" is not symmetric; use a symmetric region, or remove "
        "embryo.mirror"}},
      side_errors);
}

// Bending of single neo-Hookean elements is too soft; warned of if it matters.
TEST(InteriorKeys, BendingOfOneNeoHookeanElementIsWarnedOf) {
  const auto warnings = [](const std::string& more) {
    const Scenario scenario = load_scenario(pulled_block("[elasticity]\nmodel = \"neo-hookean\"\n" + more));
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
  const Scenario scenario =
      load_scenario({"column", "column.toml", "format = 1\n" + block_table(20, 20, 20, "1, 1, 2") + R"([region.low]
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
    Simulation simulation(load_scenario(pulled_block(more)));
    EXPECT_EQ(simulation.run(), RunStatus::end_time);
    return simulation.state().positions;
  };
  for (const std::string volume : {"[volume]\nmethod = \"none\"\n", ""}) {
    const Vectors a = end("[elasticity]\nyoung_modulus_Pa = 300\n" + volume);
    const Vectors b = end("[elasticity.all]\nregion = \"all\"\nyoung_modulus_Pa = 300\n" + volume);
    const Vectors other = end(volume);
    EXPECT_LE(largest_distance(a, b), 1e-6);
    EXPECT_GT(largest_distance(a, other), 0.1);
  }
}

}  // namespace
