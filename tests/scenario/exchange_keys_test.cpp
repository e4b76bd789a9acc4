// Keys of [exchange], and of the direction and the noise of cortices.
#include "support/scenarios.hpp"

namespace {

const std::string soft_sheet = sheet_table(36, 36, 10, 36) + "[elasticity]\nmodel = \"neo-hookean\"\n",
                  exchanging = soft_sheet + "[exchange]\nbelow_um = 0.35\n";
const std::string lateral_cortex = "[cortex.a]\nregion = \"all\"\nfaces = \"lateral\"\n",
                  apical_cortex = "[cortex.a]\nregion = \"all\"\ntension_mN_per_m = 1\n";

TEST(ExchangeKeys, SayWhatWouldBeRight) {
  const WrongScenarios cases = {
      {soft_sheet + "[exchange]\nregion = \"all\"",
       "9: exchange.below_um: is missing; set below_um to the length at which lateral faces turn, such as 0.35"},
      {exchanging + "new_length_um = 0.3",
       "11: exchange.new_length_um: 0.3 is not above below_um; set it to about 1.7 times below_um, or faces turn back"},
      {exchanging + "region = \"belly\"", "11: exchange.region: region \"belly\" does not exist; use one of: all"},
      {sheet_table(36, 36, 10, 36) + "[exchange]\nbelow_um = 0.35",
       " elasticity.model: \"corotational\" has no rule for new shapes beside [exchange]; set model to "
       "\"neo-hookean\", or remove [exchange]"},
      {exchanging + "[contraction.a]\nregion = \"all\"\nstiffness_nN_per_um = 1",
       "11: contraction.a: springs along edges are not possible beside [exchange]; use [cortex.NAME], whose faces "
       "follow, or remove [exchange]"},
      {exchanging + "[pressure.a]\nregion = \"all\"\npressure_Pa = 1",
       "11: pressure.a: loads on reference faces are not possible beside [exchange]; remove the table, or remove "
       "[exchange]"},
      {exchanging + lateral_cortex + "stiffness_mN_per_m = 1",
       "11: cortex.a.relaxation_s: new lateral faces have no stress-free area without relaxation beside [exchange]; "
       "set relaxation_min, for example to 1, or remove [exchange]"},
      {exchanging + lateral_cortex + "tension_mN_per_m = 1\nfollow = { measure = \"height_ratio\", from = 1, to = 2 }",
       "15: cortex.a.follow: activation by the shape of cells, whose reference changes, is not possible beside "
       "[exchange]; use a program, or remove [exchange]"},
      {exchanging + "[volume]\nmethod = \"none\"\n[time]\nscheme = \"linearly-implicit\"\nstep_s = 1",
       "14: time.scheme: the paper's algorithm does not support exchange of neighbours; remove [exchange], or set "
       "time.scheme to \"newton\" and volume.method to \"coupled\" or \"none\""},
      {soft_sheet + "[extrusion.a]\nregion = \"all\"\napical_area_below_um2 = 5",
       "9: extrusion.a: cells lose neighbours only by exchange; set exchange.below_um, for example to 0.35"},
      {exchanging + "[extrusion.a]\nregion = \"all\"",
       "11: extrusion.a: has no effect; set apical_area_below_um2 or basal_area_below_um2, for example to 5"},
      {lateral_cortex + "tension_mN_per_m = 1\nnoise = { spread = 0.5 }",
       "5: cortex.a.noise.correlation_s: is missing; set it to the time in which tensions change, such as 120"},
      {lateral_cortex + "tension_mN_per_m = 1\nnoise = { correlation_s = 5 }",
       "5: cortex.a.noise.spread: is missing; set it to a relative deviation, such as 0.5"},
      {lateral_cortex + "tension_mN_per_m = 1\ndirection = { strongest = 2 }",
       "5: cortex.a.direction.axis: is missing; set axis to \"along\" or \"across\""},
      {lateral_cortex + "tension_mN_per_m = 1\ndirection = { axis = \"along\" }",
       "5: cortex.a.direction: has no effect, since strongest equals weakest; set strongest above weakest"},
      {lateral_cortex + "tension_mN_per_m = 1\ndirection = { axis = \"along\", strongest = -1 }",
       "5: cortex.a.direction.strongest: -1 is out of range; set strongest to a number >= 0"},
      {lateral_cortex + "stiffness_mN_per_m = 1\nnoise = { spread = 0.5, correlation_s = 5 }",
       "5: cortex.a.noise: is not used without tension_mN_per_m; remove it, or set tension_mN_per_m"},
      {apical_cortex + "noise = { spread = 0.5, correlation_s = 60 }",
       "4: cortex.a.noise: acts on lateral faces only; remove it, or set faces to \"lateral\""},
      {lateral_cortex + "tension_mN_per_m = 1\ndirection = { axis = \"along\", weakest = 0, array = \"angle\" }",
       "5: cortex.a.direction.array: acts on apical and basal faces only; remove it, or change faces"},
      {apical_cortex + "direction = { array = \"angle\" }",
       "4: cortex.a.direction.axis: is missing; set axis to \"along\" or \"across\""},
      {lateral_cortex + "tension_mN_per_m = 1\ndirection = { axis = \"stretch\", weakest = 0 }",
       "5: cortex.a.direction.axis: acts on apical and basal faces only; set axis to \"along\" or \"across\""},
      {apical_cortex + "direction = { axis = \"long-axis\", weakest = 0, array = \"angle\" }",
       "4: cortex.a.direction.array: conflicts with an axis of the cell; remove it, or set axis to \"along\""},
      {apical_cortex + "stiffness_mN_per_m = 1\ndirection = { axis = \"long-axis\", weakest = 0 }",
       "5: cortex.a.direction.axis: stiffness_mN_per_m cannot turn with the cell, which needs energy; put "
       "stiffness_mN_per_m into another [cortex.NAME]"},
      {apical_cortex + "direction = { axis = \"along\", weakest = 1.5 }",
       "4: cortex.a.direction.weakest: 1.5 exceeds strongest; exchange both values, and turn axis"},
      {"embryo.mirror = [\"y\"]\n" + apical_cortex + "direction = { axis = \"along\", weakest = 0, array = \"angle\" }",
       "5: cortex.a.direction.array: mirror planes are not possible beside angles by cell; remove it, or remove "
       "embryo.mirror"},
      {exchanging + apical_cortex + "direction = { axis = \"along\", weakest = 0 }",
       "14: cortex.a.direction: apical and basal faces have no direction beside [exchange]; remove direction, or "
       "remove "
       "[exchange]"},
      {soft_sheet + "[growth.a]\nregion = \"all\"\nrate_per_h = 1\n" + apical_cortex +
           "direction = { axis = \"along\", weakest = 0 }",
       "15: cortex.a.direction: apical and basal faces have no direction beside [growth.NAME]; remove direction, or "
       "remove [growth.NAME]"},
  };
  expect_errors(cases, load_errors);
}

TEST(DirectionKeys, GiveApicalFacesFibres) {
  const auto energy = [](const std::string& direction) {
    const auto model = make_model(scenario_of(block_table(60, 40, 10, "3, 2, 1") + apical_cortex + direction));
    Step step;
    Vectors stretched = model->tissue.rest_positions;
    for (Vec3& x : stretched) x.x() *= 1.5;
    step.positions = step.previous_positions = stretched;
    for (const auto& law : model->laws)
      if (law->label() == "cortex.a") return law->energy(step);
    return 0.0;
  };
  EXPECT_NEAR(energy(""), 1.5 * 2400, 1e-9);
  EXPECT_NEAR(energy("direction = { axis = \"across\", weakest = 0.2 }"), (0.2 * 1.5 + 0.8) * 2400, 1e-9);
  EXPECT_NEAR(energy("direction = { axis = \"along\", strongest = 2, weakest = 0.5 }"), 2 * 1.5 * 2400, 1e-9);
  EXPECT_SAYS(model_errors(block_table(60, 40, 10, "3, 2, 1") + apical_cortex +
                           "direction = { axis = \"along\", weakest = 0, array = \"angle\" }"),
              "cortex.a.direction.array: the embryo has no array \"angle\"");
}

TEST(ExchangeKeys, AreRefusedForCellsWithoutRule) {
  const std::string remedy =
      "; use one layer of polygons, as of shape \"sheet\" or \"egg\", with embryo.elements \"diagonals\"";
  const std::string keys = "[elasticity]\nmodel = \"neo-hookean\"\n[exchange]\nbelow_um = 0.35\n";
  EXPECT_SAYS(model_errors(sheet_table(36, 36, 10, 36) + "elements = \"kites\"\n" + keys),
              "exchange: the cells of this embryo cannot exchange neighbours: its cells are split into kites" + remedy);
  EXPECT_SAYS(model_errors(block_table(60, 40, 40, "3, 2, 1") + keys), "squares of a grid");
  EXPECT_EQ(model_errors(sheet_table(36, 36, 10, 36) + keys), "");
}

TEST(ExchangeKeys, HaveTheirDefaults) {
  const Scenario scenario = scenario_of(exchanging);
  EXPECT_DOUBLE_EQ(*scenario.exchange.new_length_um, 1.7 * 0.35);
  EXPECT_EQ(scenario.exchange.again_after_s, 5);
  EXPECT_FALSE(scenario_of(soft_sheet).exchange.below_um);
}

}  // namespace
