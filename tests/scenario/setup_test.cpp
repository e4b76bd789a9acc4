// What follows from a scenario: furrow region, automatic values, axes, what has no mirror image; rules of monitors,
// criteria and times.
#include "scenario/setup.hpp"

#include "scenario/embryo_axes.hpp"
#include "scenario/print.hpp"
#include "support/scenarios.hpp"
#include "tissue/shapes/embryo.hpp"

namespace {

// Strip of seven cells with contractions in three regions, of one, three and two cells.
Scenario three_contractions(const std::string& more = "") {
  std::string text =
      "[embryo]\nshape = \"block\"\nlength_um = 140\nwidth_um = 20\ncell_height_um = 30\ncells = [7, 1, "
      "1]\n[region.one]\nids = [0]\n[region.three]\nids = [2, 3, 4]\n[region.two]\nids = [5, 6]\n";
  for (const std::string region : {"one", "three", "two"})
    text += "[contraction." + region + "]\nregion = \"" + region + "\"\nstiffness_nN_per_um = 1\n";
  return load_scenario({"strip", "strip.toml", text + more});
}

TEST(FurrowRegion, IsTheLargestOnWhichContractionsAct) {
  const Scenario scenario = three_contractions();
  const Tissue tissue = make_tissue(scenario);
  EXPECT_EQ(contracting_regions(scenario, tissue), (std::vector<std::string>{"three", "two", "one"}));
  EXPECT_EQ(make_furrow_sites(scenario, tissue).contractile, tissue.regions.at("three"));
}

TEST(FurrowRegion, IsTheOneThatIsNamed) {
  const Scenario scenario = three_contractions("[furrow]\nregion = \"one\"\nvce_cell = 1\n");
  const Tissue tissue = make_tissue(scenario);
  EXPECT_EQ(make_furrow_sites(scenario, tissue).contractile, tissue.regions.at("one"));
}

TEST(FurrowRegion, IsNoneWithoutContraction) {
  Scenario scenario = three_contractions();
  scenario.contractions.clear();
  const Tissue tissue = make_tissue(scenario);
  const FurrowSites sites = make_furrow_sites(scenario, tissue);
  EXPECT_EQ(std::ranges::count(sites.contractile, true), 0);
  EXPECT_TRUE(sites.vml.empty());
}

using Overrides = std::vector<std::string>;

double barrier_Pa(const std::string& text, const Overrides& overrides = {}) {
  return *scenario_of(text, overrides).elasticity.corner_barrier_Pa;
}

const std::string three_cells = "[embryo]\nshape = \"block\"\ncells = [3, 1, 1]\n";
const std::string cut = "[division.cut]\nregion = \"all\"\nat_s = 5\n";

TEST(AutomaticBarrier, IsATenthOfYoungsModulusWhereCellsArePolygonsOrDivide) {
  for (const char* shape :
       {"egg", "sheet", "points\"\nfile = \"p.csv", "surface\"\nfile = \"s.obj", "file\"\nfile = \"m.vtu"}) {
    const std::string text = "[embryo]\nshape = \"" + std::string(shape) + "\"\n";
    EXPECT_EQ(barrier_Pa(text), 100) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\nyoung_modulus_Pa = 30\n"), 3) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\ncorner_barrier_Pa = 0\n"), 0) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\ncorner_barrier_Pa = 7\n"), 7) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\ncorner_barrier_Pa = 7\n", {"elasticity.corner_barrier_Pa=automatic"}),
              100)
        << shape;
  }
  EXPECT_EQ(barrier_Pa(three_cells + cut), 100);
}

TEST(AutomaticBarrier, IsNoneOnGridsThatDoNotDivide) {
  for (const char* shape : {"pill", "sphere", "slice", "block"})
    EXPECT_EQ(barrier_Pa("[embryo]\nshape = \"" + std::string(shape) + "\"\n"), 0) << shape;
  EXPECT_EQ(barrier_Pa("base = \"drosophila\"\n"), 0);
  EXPECT_EQ(barrier_Pa("base = \"drosophila-living\"\n"), 10);
  // The paper's algorithm reproduces the paper.
  EXPECT_EQ(barrier_Pa("[embryo]\nshape = \"file\"\nfile = \"m.vtu\"\n[volume]\nmethod = \"projection\"\n"), 0);
}

TEST(AutomaticIntegrator, IsOfSecondOrderWhereItCanBe) {
  for (const char* shape : {"pill", "sphere", "slice", "block", "egg", "sheet"})
    EXPECT_EQ(scenario_of("[embryo]\nshape = \"" + std::string(shape) + "\"\n").time.integrator, "bdf2") << shape;
  for (const std::string bar :
       {"time.scheme=linearly-implicit", "volume.method=projection", "dynamics.density_kg_per_m3=1"}) {
    Overrides overrides = {bar};
    if (bar.starts_with("time")) overrides.emplace_back("volume.method=none");
    EXPECT_EQ(scenario_of(three_cells, overrides).time.integrator, "backward-euler") << bar;
  }
  EXPECT_EQ(scenario_of(three_cells, {"time.integrator=backward-euler"}).time.integrator, "backward-euler");
}

TEST(AutomaticValues, AreRecordedAsNumbers) {
  const std::string text = resolved_toml(scenario_of("[embryo]\nshape = \"sheet\"\n"));
  EXPECT_SAYS(text, "\ncorner_barrier_Pa = 100\n");
  EXPECT_SAYS_NOT(text, "integrator = \"automatic\"");
}

EmbryoAxes axes_in(const std::string& keys) { return axes_of(scenario_of("[embryo]\n" + keys).embryo); }

TEST(EmbryoAxes, AreAnatomicalForEmbryosAndPlainForOtherTissues) {
  EXPECT_EQ(axes_in(""), anatomical_axes());
  EXPECT_EQ(axes_in("shape = \"egg\""), anatomical_axes());
  EXPECT_EQ(axes_in("shape = \"sheet\""), plain_axes());
  EXPECT_EQ(axes_in("shape = \"block\""), plain_axes());
  EXPECT_EQ(plain_axes()[0], (std::array<std::string, 2>{"\u2212x", "+x"}));
  EXPECT_TRUE(have_furrow(anatomical_axes()));
  EXPECT_FALSE(have_furrow(plain_axes()));
}

TEST(EmbryoAxes, AreThoseOfTheScenario) {
  const EmbryoAxes axes = axes_in("shape = \"sheet\"\naxes = [\"proximal-distal\", \"anterior-posterior\", \"depth\"]");
  EXPECT_EQ(axes, (EmbryoAxes{{{"proximal", "distal"}, {"anterior", "posterior"}, {"\u2212depth", "+depth"}}}));
  EXPECT_TRUE(have_furrow(axes_in("shape = \"sheet\"\naxes = [\"x\", \"y\", \"ventral-dorsal\"]")));
}

TEST(EmbryoAxes, LettersAreTheShortestThatDiffer) {
  EXPECT_EQ(letters_of(anatomical_axes()), (EmbryoAxes{{{"A", "P"}, {"L", "R"}, {"V", "D"}}}));
  EXPECT_EQ(letters_of(plain_axes()), plain_axes());
  EXPECT_EQ(letters_of({{{"proximal", "distal"}, {"anterior", "posterior"}, {"basal", "api"}}}),
            (EmbryoAxes{{{"Pr", "D"}, {"An", "Po"}, {"B", "Ap"}}}));
  EXPECT_EQ(letters_of({{{"in", "inner"}, {"\u00fcber", "unter"}, {"a", "b"}}}),
            (EmbryoAxes{{{"In", "Inn"}, {"\u00fc", "U"}, {"A", "B"}}}));
}

TEST(EmbryoAxes, OtherListsAreRefused) {
  const std::string remedy = "; write, for example, [\"proximal-distal\", \"anterior-posterior\", \"z\"]";
  const WrongScenarios cases = {{R"(["x", "y"])", "has 2 names, not three"},
                                {R"(["x"])", "has 1 name, not three"},
                                {R"(["x", "y", "-z"])", R"("-z" is neither "low-high" nor one word)"},
                                {R"(["a-b", "c-", "z"])", R"("c-" is neither "low-high" nor one word)"},
                                {R"(["a-b", "c-d-e", "z"])", R"("c-d-e" is neither "low-high" nor one word)"},
                                {R"(["a-b", "b-c", "z"])", R"("b" names two ends)"},
                                {R"(["a-a", "y", "z"])", R"("a" names two ends)"}};
  for (const auto& one : cases)
    EXPECT_EQ(errors_in([&] { return axes_in("axes = " + one.first); }),
              "test.toml:2: embryo.axes: " + one.second + remedy);
}

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

TEST(Symmetry, WhatHasNoImageIsRefused) {
  const std::string right =
      "region \"right\" is not symmetric: it contains cell 95 but not its mirror image, cell 0; use a symmetric "
      "region, or remove embryo.mirror";
  const WrongScenarios cases = {
      {"[embryo]\nmirror = [\"z\"]", "2: embryo.mirror: \"z\" is unknown; set mirror to a list of: x | y"},
      {"[embryo]\nmirror = [\"y\", \"y\"]", "2: embryo.mirror: \"y\" occurs twice; list each direction once"},
      {"[embryo]\ncells = [12, 7, 6]\nmirror = [\"y\"]",
       "3: embryo.mirror: the plane y = 0 cuts cells in two, for example cell 36; give an even number of cells along "
       "y"},
      {"[embryo]\nshape = \"slice\"\nlength_um = 7\ncells = [1, 8, 6]\nmirror = [\"x\"]",
       "5: embryo.mirror: the plane x = 0 cuts cells in two, for example cell 0; give an even number of cells along x"},
      {pill + "[division.a]\nregion = \"all\"\nat_s = 5",
       "6: embryo.mirror: mirrored cells cannot divide; remove mirror, or [division]"},
      {pill + "[volume]\nmethod = \"projection\"",
       "6: embryo.mirror: the paper's algorithm does not support mirror planes; remove mirror, or set time.scheme to "
       "\"newton\" and volume.method to \"coupled\" or \"none\""},
      {pill + "[contraction.a]\nregion = \"right\"\nstiffness_nN_per_um = 1", "12: contraction.a.region: " + right},
      {pill + "[cortex.a]\nregion = \"right\"\ntension_mN_per_m = 1", "12: cortex.a.region: " + right},
      {pill + "[ablation.a]\nregion = \"right\"\nat_s = 1", "12: ablation.a.region: " + right},
      {pill + "[pressure.a]\nregion = \"right\"\npressure_Pa = 1", "12: pressure.a.region: " + right},
      {pill + "[cortex.a]\nregion = \"belly\"\ntension_mN_per_m = 1\nvariation = { spread = 0.3 }",
       "11: cortex.a: is not symmetric: the factor is 0.8292 in cell 0 and 0.5967 in its mirror image, cell 95; make "
       "variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[contraction.a]\nregion = \"belly\"\nstiffness_nN_per_um = 1\ndelay = { speed_um_per_s = 1, from = "
              "\"low\" }",
       "11: contraction.a: is not symmetric: the delay is 11.48 s in cell 0 and 193 s in its mirror image, cell 95; "
       "make variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[contraction.a]\nregion = \"belly\"\nstiffness_nN_per_um = 1\npulse = { period_s = 60 }",
       "11: contraction.a: is not symmetric: the pulse phase is 0.8882 in cell 0 and 0.4079 in its mirror image, cell "
       "95; make variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[elasticity.a]\nregion = \"belly\"\nprofile = { shape = \"table\", at_um = [-90, 90], factor = [1, 2] }",
       "11: elasticity.a: is not symmetric: the factor is 1.235 in cell 0 and 1.765 in its mirror image, cell 95; make "
       "variation, delay, pulse and profile symmetric, or remove embryo.mirror"},
      {pill + "[hold.a]\nregion = \"all\"\nz_um = [0, 200]\ny_um = [10, 20]",
       "11: hold.a: is not symmetric: only one of the node at -118.731, -11.1918, 0 um and its mirror image is fixed; "
       "use a symmetric region and ranges, or remove embryo.mirror"},
  };
  expect_errors(cases, side_errors);
}

// Regions used for measurement only need not be symmetric.
TEST(Symmetry, RegionsThatAreOnlyMeasuredMayLieOnOneSide) {
  EXPECT_EQ(
      side_errors(
          pill +
          "[cortex.a]\nregion = \"belly\"\ntension_mN_per_m = 1\n[monitor.a]\nquantity = \"area\"\nregion = \"right\""),
      "");
}

TEST(Symmetry, WithoutPlanesNothingIsHalved) {
  const Scenario scenario = scenario_of("[embryo]\ncells = [7, 5, 3]");
  EXPECT_FALSE(make_solved_side(scenario, *make_model(scenario)));
  EXPECT_TRUE(scenario_of(pill, {"embryo.mirror=[]"}).embryo.mirror.empty());
}

const std::string floor_monitor = "[monitor.floor]\nquantity = \"position\"\naxis = \"z\"\n";  // three lines

TEST(MonitorRules, EveryErrorIsOneLineWithARemedy) {
  const WrongScenarios cases = {
      {"[monitor.a]",
       "1: monitor.a.quantity: is missing; set quantity to one of: position | displacement | speed | velocity | "
       "deviation | relative_energy_norm | surface_distance | force | volume | area | area_ratio | apical_elongation | "
       "pressure | stress | apical_load | inward_displacement | depth | curvature | kinetic_energy | time | wall"},
      {"[monitor.a]\nquantity = \"speed\"\nregion = \"al\"",
       "3: monitor.a.region: region \"al\" does not exist; use \"all\" (nearest match)"},
      {"[monitor.a]\nquantity = \"position\"", "1: monitor.a.axis: is missing; set axis to \"x\", \"y\" or \"z\""},
      {"[monitor.a]\nquantity = \"speed\"\naxis = \"z\"",
       "3: monitor.a.axis: is not used with quantity \"speed\"; remove axis, or set quantity to \"velocity\""},
      {"[monitor.a]\nquantity = \"volume\"\nface = \"apical\"",
       "3: monitor.a.face: is not used with quantity \"volume\"; remove face"},
      {"[monitor.a]\nquantity = \"time\"\nover = \"max\"",
       "3: monitor.a.over: is not used with quantity \"time\"; remove over, since the quantity has a single value"},
      {"[monitor.a]\nquantity = \"deviation\"",
       "1: monitor.a.reference: is missing; set reference to the results directory of a run"},
      {"[monitor.a]\nquantity = \"surface_distance\"",
       "1: monitor.a.reference: is missing; set reference to a mesh file"},
      {"[monitor.a]\nquantity = \"speed\"\nreference = \"b\"",
       "3: monitor.a.reference: is not used with quantity \"speed\"; remove reference"},
      {"[monitor.a]\nquantity = \"surface_distance\"\nreference = \"b\"\nreference_at = \"end\"",
       "4: monitor.a.reference_at: is not used with quantity \"surface_distance\"; remove reference_at"},
      {"[monitor.a]\nquantity = \"kinetic_energy\"",
       "2: monitor.a.quantity: kinetic energy requires a density above 0; set dynamics.density_kg_per_m3, or set "
       "quantity to \"speed\""},
      {"[volume]\nmethod = \"none\"\n[monitor.a]\nquantity = \"pressure\"",
       "4: monitor.a.quantity: cell pressure requires conserved cell volumes; set volume.method to \"coupled\""},
      {"[elasticity]\nmodel = \"shape-memory\"\n[monitor.a]\nquantity = \"stress\"",
       "4: monitor.a.quantity: model \"shape-memory\" has no stress; set elasticity.model to \"corotational\""},
      // Criteria.
      {"[stop.a]\nabove = 1", "1: stop.a.monitor: is missing; set monitor to a text"},
      {floor_monitor + "[stop.a]\nmonitor = \"floor\"", "4: stop.a: has no bound; set above or below"},
      {"[stop.a]", "1: stop.a.monitor: is missing; set monitor to a text\n1: stop.a: has no bound; set above or below"},
      {floor_monitor + "[stop.a]\nmonitor = \"flor\"\nabove = 1",
       "5: stop.a.monitor: monitor \"flor\" does not exist; use \"floor\" (nearest match)"},
      {"[stop.a]\nmonitor = \"floor\"\nabove = 1",
       "2: stop.a.monitor: monitor \"floor\" does not exist; define [monitor.floor]"},
      {floor_monitor + "[stop.a]\nmonitor = \"floor\"\nabove = 3\nbelow = 3",
       "6: stop.a.above: no value lies above 3 and below 3; reduce above, or define two criteria"},
      {floor_monitor + "[stop.equilibrium]\nmonitor = \"floor\"\nabove = 3",
       "4: stop.equilibrium: \"equilibrium\" is a predefined criterion; rename the table, or set "
       "stop.equilibrium_speed_um_per_min"},
      {"[monitor.t]\nquantity = \"time\"\n[stop.a]\nmonitor = \"t\"\nabove = 3\nover = \"any\"",
       "6: stop.a.over: monitor \"t\" has a single value; remove over"},
      // Expectations of monitors.
      {floor_monitor + "[expect]\nfloor.position_m = { value = 1, within = 1 }",
       "5: expect.floor.position_m: no monitor has this name; use \"floor.position_um\" (nearest match)"},
      {"[expect]\n\"floor.position_um\" = { value = 1, within = 1 }",
       "2: expect.floor.position_um: no monitor has this name; define the monitor as [monitor.NAME]"},
      {floor_monitor + "[expect]\nfloor.position_um = { value = 1 }",
       "5: expect.floor.position_um: has no tolerance; set within or within_percent"},
  };
  expect_errors(cases, load_errors);
}

const std::string rich = floor_monitor + R"(region = "belly"
face = "apical"
over = "max"
[monitor.clock]
quantity = "time"
[region.belly]
face = "ventral"
[stop]
combine = "all"
at_equilibrium = false
late = { monitor = "clock", above = 60 }
[stop.deep]
monitor = "floor"
above = -120
below = 0
over = "any"
[expect]
floor.position_um = { value = -120, within = 1 }
)";

TEST(MonitorRules, ResolvedScenarioLoadsBack) {
  const Scenario scenario = scenario_of(rich);
  EXPECT_EQ(scenario.expect.count("floor.position_um"), 1U);
  EXPECT_EQ(scenario.criteria.size(), 2U);
  const std::string text = resolved_toml(scenario);
  EXPECT_EQ(resolved_toml(scenario_of(text)), text);
}

TEST(MonitorRules, SetReachesCriteriaAndExpectations) {
  const Scenario scenario = load_scenario(
      {"test", "test.toml", rich}, {"stop.deep.above=-100", "stop.combine=any", "expect.floor.position_um.within=2"});
  EXPECT_EQ(scenario.criteria.at("deep").above, -100);
  EXPECT_EQ(scenario.stop.combine, "any");
  EXPECT_EQ(scenario.expect.at("floor.position_um").within, 2);
}

TEST(MeasurePlan, MakesMonitorsAndCriteriaOfAScenario) {
  Tissue tissue = build_shell({.length_um = 460, .cells = {18, 9, 8}});
  tissue.regions["belly"] = tissue.regions.at("all");
  const MeasurePlan plan = make_measure_plan(scenario_of(rich), Model(tissue));
  ASSERT_EQ(plan.monitors.size(), 2U);
  EXPECT_EQ(plan.monitors[0].column(), "clock.time_s");
  EXPECT_EQ(plan.monitors[1].column(), "floor.position_um");
  EXPECT_EQ(plan.monitors[1].axis, 2);
  EXPECT_EQ(plan.monitors[1].over, Over::max);
  EXPECT_EQ(plan.monitors[1].face, CellSide::apical);
  EXPECT_TRUE(plan.stop.all);
  EXPECT_FALSE(plan.stop.needs_rest);
  ASSERT_EQ(plan.stop.criteria.size(), 2U);
  EXPECT_EQ(plan.stop.criteria[0].monitor, 1U);  // deep is on floor
  EXPECT_EQ(plan.stop.criteria[0].over, Criterion::Over::any);
  EXPECT_EQ(plan.stop.criteria[1].monitor, 0U);  // late on clock
  EXPECT_EQ(plan.stop.criteria[1].above, 60);
}

std::string program_errors(const std::string& override_text) {
  return errors_in([&] {
    return load_scenario(find_scenario("drosophila"),
                         std::vector<std::string>{override_text, "contraction.apical.program.activity=[1, 1, 0]"});
  });
}

TEST(TimeRules, AProgramMayJumpButNotTwiceAtOnce) {
  EXPECT_EQ(program_errors("contraction.apical.program.time_s=[0, 10, 10]"), "");
  EXPECT_SAYS(program_errors("contraction.apical.program.time_s=[10, 10, 10]"), "10 occurs three times");
  EXPECT_SAYS(program_errors("contraction.apical.program.time_s=[0, 10, 10.0000001]"), "closer than 1e-06 s");
  EXPECT_SAYS(program_errors("contraction.apical.program.time_s=[0, 10, 9]"), "do not increase");
}

TEST(TimeRules, ARunLastsLongerThanAnInstant) {
  const auto ends_at = [](const char* end) {
    return load_scenario(find_scenario("drosophila"), std::vector<std::string>{std::string("time.end_s=") + end});
  };
  EXPECT_THROW(ends_at("1e-7"), ScenarioError);
  EXPECT_NO_THROW(ends_at("1e-5"));
}

}  // namespace
