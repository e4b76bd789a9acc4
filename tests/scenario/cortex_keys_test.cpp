// Keys for furrow closure: cortices, enclosed volumes, inversion barrier, profiles in cells and tapers.
#include <gtest/gtest.h>

#include <algorithm>

#include "measure/monitor.hpp"
#include "record/archive.hpp"
#include "record/checkpoint.hpp"
#include "scenario/load.hpp"
#include "scenario/setup.hpp"
#include "simulation/simulation.hpp"
#include "support/small_furrow.hpp"

namespace plica {
namespace {

const std::string cortex = "[cortex.a]\nregion = \"all\"\n";

std::vector<std::string> complaints(const std::string& text) {
  try {
    (void)load_scenario({"test", "test.toml", text});
  } catch (const ScenarioError& error) {
    std::vector<std::string> lines;
    for (const Diagnostic& diagnostic : error.diagnostics()) lines.push_back(diagnostic.text());
    return lines;
  }
  return {};
}

TEST(CortexKeys, SayWhatWouldBeRight) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {cortex, "test.toml:1: cortex.a: has no effect; set tension_mN_per_m, stiffness_mN_per_m or crowding_mN_per_m"},
      {cortex + "tension_mN_per_m = -1",
       "test.toml:3: cortex.a.tension_mN_per_m: -1 is out of range; set tension_mN_per_m to a number >= 0"},
      {cortex + "tension_mN_per_m = 1\nfaces = \"top\"",
       "test.toml:4: cortex.a.faces: \"top\" is unknown; set faces to one of: apical | basal | lateral"},
      {cortex + "stiffness_mN_per_m = 1\nsaturation_ratio = 0.2",
       "test.toml:4: cortex.a.saturation_ratio: is not used without tension_mN_per_m; remove it, or set "
       "tension_mN_per_m"},
      {cortex + "tension_mN_per_m = 1\ncompression_ratio = 0.1",
       "test.toml:4: cortex.a.compression_ratio: is not used without stiffness_mN_per_m; remove it, or set "
       "stiffness_mN_per_m"},
      {cortex + "tension_mN_per_m = 1\nrelaxation_min = 0",
       "test.toml:4: cortex.a.relaxation_min: 0 is out of range; set relaxation_min to a number > 0 or \"none\""},
      {cortex + "stiffness_mN_per_m = 1\nstiffness_program = { time_min = [0, 1], activity = [1] }",
       "test.toml:4: cortex.a.stiffness_program.activity: has length 1 for 2 times; set activity to as many values as "
       "times"},
      {"[cortex.apical]\nregion = \"all\"\ntension_mN_per_m = 1\n[cortex.apicl]\ntension_mN_per_m = 2",
       "test.toml:4: cortex.apicl.region: is missing; set region to a text, or rename the table to cortex.apical "
       "(nearest match)"},
      {"[cortex.a]\nregion = \"mesoderm\"\ntension_mN_per_m = 1",
       "test.toml:2: cortex.a.region: region \"mesoderm\" does not exist; use one of: all"},
      {cortex + "tension_mN_per_m = 1\nprofile = { shape = \"gaussian\", sigma_um = 3, sigma_cells = 2 }",
       "test.toml:4: cortex.a.profile.sigma_um: conflicts with cortex.a.profile.sigma_cells, which is also set; remove "
       "one of them"},
      {cortex + "tension_mN_per_m = 1\nprofile = { edge = 0.5 }",
       "test.toml:4: cortex.a.profile.edge: is not used with a constant profile; remove it, or set another shape or a "
       "taper"},
      {cortex + "tension_mN_per_m = 1\nprofile = { shape = \"plateau\", full_cells = 3 }",
       "test.toml:4: cortex.a.profile.fade_cells: is missing; set fade_cells to the width of the taper in cells (0: "
       "none)"},
      {cortex +
           "tension_mN_per_m = 1\nprofile = { shape = \"plateau\", full_cells = 3, fade_cells = 1, about = \"belly\" }",
       "test.toml:4: cortex.a.profile.about: region \"belly\" does not exist; use one of: all"},
      {cortex + "tension_mN_per_m = 1\ntrigger = { below = 0.3 }",
       "test.toml:4: cortex.a.trigger.measure: is missing; set measure to one of: apical_area_ratio | basal_area_ratio "
       "| height_ratio | apical_stretch"},
      {cortex + "tension_mN_per_m = 1\ntrigger = { measure = \"height_ratio\" }",
       "test.toml:4: cortex.a.trigger.below: is missing; set either below or above"},
      {cortex + "tension_mN_per_m = 1\nfollow = { measure = \"height_ratio\", from = 1, to = 1 }",
       "test.toml:4: cortex.a.follow.to: equals `from`; set `to` to a different value"},
      {cortex + "tension_mN_per_m = 1\nfollow = { measure = \"height_ratio\", from = 1, to = 2 }\ntrigger = { measure "
                "= \"height_ratio\", below = 1 }",
       "test.toml:4: cortex.a.follow: conflicts with `trigger`; remove one of them"},
      {cortex +
           "tension_mN_per_m = 1\ndelay = { speed_um_per_s = 1 }\ntrigger = { measure = \"height_ratio\", below = 1 }",
       "test.toml:5: cortex.a.trigger: conflicts with `delay`, which activates cells at prescribed times; remove one "
       "of them"},
      {cortex + "tension_mN_per_m = 1\nprofile = { full_length_um = 300 }",
       "test.toml:4: cortex.a.profile.fade_um: is missing; set both full_length_um and fade_um"},
      {"[enclosed.yolk]\nvolume = \"compliant\"\n[vitelline]\ngap_um = 1",
       "test.toml:1: enclosed.yolk.bulk_modulus_Pa: is missing; set bulk_modulus_Pa to a number > 0"},
      {"[enclosed.yolk]\nbulk_modulus_Pa = 10\n[vitelline]\ngap_um = 1",
       "test.toml:2: enclosed.yolk.bulk_modulus_Pa: is not used with volume \"held\"; remove bulk_modulus_Pa, or set "
       "volume to \"compliant\""},
      {"[enclosed.yolk]\nvolume = \"held\"",
       "test.toml:2: enclosed.yolk.volume: no cell can leave the vitelline membrane, since cell and enclosed volumes "
       "are fixed and the gap is 0; set vitelline.gap_um, for example to 0.5, or volume to \"compliant\""},
      {"[embryo]\nshape = \"slice\"\n[division.a]\nregion = \"all\"\nat_s = 5",
       "test.toml:2: embryo.shape: cells of a slice cannot divide, since its cross-sections must stay alike; set shape "
       "to \"pill\", or remove [division]"},
      {"[embryo]\nshape = \"block\"\n[enclosed.yolk]\nvolume = \"held\"",
       "test.toml:3: enclosed.yolk: a block encloses no volume; remove the table, or set embryo.shape to \"pill\" or "
       "\"sphere\""},
      {"[enclosed.yolk]\nvolume = \"held\"\n[volume]\nmethod = \"projection\"",
       "test.toml:2: enclosed.yolk.volume: \"held\" requires time.scheme \"newton\" and a volume.method other than "
       "\"projection\"; set volume to \"compliant\", or change time.scheme or volume.method"},
      {"[enclosed.a]\nvolume = \"held\"\n[enclosed.b]\nsurface = \"basal\"\n[vitelline]\ngap_um = 1",
       "test.toml:4: enclosed.b.surface: another table already constrains this volume; remove one of the two tables"},
      {cortex + "tension_mN_per_m = 1\nprogram = { time_min = [0, inf], activity = [0, 1] }",
       "test.toml:4: cortex.a.program.time_min: inf is not a finite number; set time_min to a list of numbers"},
      {cortex + "tension_mN_per_m = 1\nprogram = { time_min = [5, 1], activity = [0, 1] }",
       "test.toml:4: cortex.a.program.time_min: the times do not increase; list times in increasing order; repeat a "
       "time once to mark a jump"},
      {cortex + "tension_mN_per_m = 1\nprogram = { time_min = [0, 1], activity = [0, -1] }",
       "test.toml:4: cortex.a.program.activity: -1 is out of range; set activity to a list of numbers >= 0"},
      {"[self_contact]\nsurface = \"apical\"\nstiffness_kPa_per_um = 0",
       "test.toml:3: self_contact.stiffness_kPa_per_um: 0 is out of range; set stiffness_kPa_per_um to a number > 0"},
      {"[self_contact]\nsurface = \"apical\"\ndistance_um = 10",
       "test.toml:1: self_contact.search_um: 6 is below twice distance_um; set search_um to several times distance_um"},
      {"[elasticity]\ncorner_barrier_Pa = -1",
       "test.toml:2: elasticity.corner_barrier_Pa: -1 is out of range; set corner_barrier_Pa to a number >= 0 or "
       "\"automatic\""},
      {"[self_contact]\nsurface = \"apical\"\nfriction = -0.1",
       "test.toml:3: self_contact.friction: -0.1 is out of range; set friction to a number >= 0"},
      {"[self_contact]\nfriction = 0.3",
       "test.toml:2: self_contact.friction: is not used with surface \"none\"; remove friction, or set surface, for "
       "example to \"apical\""},
      {"[vitelline]\ndrag_Pa_s_per_um = -5",
       "test.toml:2: vitelline.drag_Pa_s_per_um: -5 is out of range; set drag_Pa_s_per_um to a number >= 0"},
      {"[vitelline]\nenabled = false\ndrag_Pa_s_per_um = 5",
       "test.toml:3: vitelline.drag_Pa_s_per_um: is not used without a vitelline membrane; remove drag_Pa_s_per_um, or "
       "set enabled to true"},
      {"[embryo]\nshape = \"block\"\n[vitelline]\ndrag_Pa_s_per_um = 5",
       "test.toml:4: vitelline.drag_Pa_s_per_um: is not used without a vitelline membrane; remove drag_Pa_s_per_um"},
      {"[vitelline]\ndrag_Pa_s_per_um = 5\n[volume]\nmethod = \"projection\"",
       "test.toml:2: vitelline.drag_Pa_s_per_um: requires time.scheme \"newton\" and a volume.method other than "
       "\"projection\"; remove drag_Pa_s_per_um, or change time.scheme or volume.method"},
  };
  for (const auto& [text, expected] : cases) {
    const std::vector<std::string> found = complaints(text);
    ASSERT_EQ(found.size(), 1u) << text << (found.empty() ? "" : "\n" + found[0] + "\n" + found.back());
    EXPECT_EQ(found[0], expected) << text;
  }
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
                                        "region to cells with this face, or change face"}}) {
    const Scenario scenario = load_scenario({"test", "test.toml", block + table});
    try {
      (void)make_model(scenario);
      ADD_FAILURE() << table;
    } catch (const ScenarioError& error) {
      ASSERT_EQ(error.diagnostics().size(), 1u);
      EXPECT_EQ(error.diagnostics()[0].text(), problem);
    }
  }
}

// A scenario with a fixed yolk volume may inherit the bulk modulus of its base.
TEST(CortexKeys, AHeldYolkLeavesWhatItsBaseSaysOfACompliantOne) {
  EXPECT_NO_THROW(load_scenario({"test", "test.toml", "base = \"furrow-slice\"\n[enclosed.yolk]\nvolume = \"held\""}));
}

// Invaginating ventral side, with all laws of a closing furrow.
Scenario small_furrow() {
  const std::string yolk = "[enclosed.yolk]\nvolume = \"compliant\"\nbulk_modulus_Pa = 50000\n";
  return load_scenario({"furrow", "furrow.toml", support::small_furrow + yolk});
}

// The region of the active apical cortex is where the furrow is measured.
TEST(CortexKeys, ASmallFurrowOfCorticesFolds) {
  const Scenario scenario = small_furrow();
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
  Scenario scenario = small_furrow();
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
  Scenario scenario = small_furrow();
  scenario.self_contact.friction = 0.3;
  scenario.vitelline.drag_Pa_s_per_um = 50;
  Simulation whole(scenario);
  std::optional<RunMemory> kept;
  Observation measures;
  while (whole.step())
    if (whole.steps() == 12) kept = whole.memory(), measures = whole.measures();
  ASSERT_TRUE(kept);
  Checkpoint checkpoint{"", "", "", *kept, {}};
  checkpoint.record.rows.push_back(measures);
  if (can_archive()) checkpoint = read_checkpoint_bytes(checkpoint_bytes(checkpoint));
  Simulation rest(scenario);
  rest.go_on_from(std::move(checkpoint.run), checkpoint.record.rows.back());
  EXPECT_EQ(rest.run(), whole.status());
  EXPECT_EQ(rest.steps(), whole.steps());
  EXPECT_EQ(rest.state().positions, whole.state().positions);
  EXPECT_EQ(rest.state().internals, whole.state().internals);
  std::size_t remembered = 0;
  for (const auto& internal : whole.state().internals) remembered += internal.size();
  EXPECT_GT(remembered, 0u);
}

}  // namespace
}  // namespace plica
