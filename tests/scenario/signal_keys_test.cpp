// [signal.NAME], and what follows one: errors say what would be right.
#include "scenario/print.hpp"
#include "support/scenarios.hpp"

namespace {

const std::string signal_u = "[signal.u]\n";
const std::string pulling = "[cortex.a]\nregion = \"all\"\ntension_mN_per_m = 1\n";

TEST(SignalKeys, SayWhatWouldBeRight) {
  const WrongScenarios cases = {
      {signal_u + "diffusion_um2_per_s = 3",
       "2: signal.u.diffusion_um2_per_s: unknown key; use \"diffusion_um2_per_min\" and convert the value to that "
       "unit"},
      {signal_u + "decay_per_min = -1",
       "2: signal.u.decay_per_min: -1 is out of range; set decay_per_min to a number >= 0"},
      {"[signal.\"u-1\"]\n",
       "1: signal.u-1: is not a valid name of a signal; use letters, digits and \"_\", no digit first"},
      {"[signal.sin]\n", "1: signal.sin: has the name of a measure or a function; rename the signal"},
      {signal_u + "source = { region = \"all\" }",
       "2: signal.u.source.per_min: is missing; set per_min to what its cells make in a minute"},
      {signal_u + "source = { per_min = 1 }",
       "2: signal.u.source.region: is missing; set region to the cells that make it"},
      {signal_u + "source = { region = \"organizer\", per_min = 1 }\n[region.organiser]\nface = \"left\"",
       "2: signal.u.source.region: region \"organizer\" does not exist; use \"organiser\" (nearest match)"},
      {signal_u + "reaction = \"k * strech\"\nconstants = { k = 1 }",
       "2: signal.u.reaction: \"strech\" is unknown; use signals (u), measures (apical_area_ratio, basal_area_ratio, "
       "height_ratio, apical_stretch), or names in constants"},
      {signal_u + "reaction = \"2 * height_ration\"",
       "2: signal.u.reaction: \"height_ration\" is unknown; use \"height_ratio\" (nearest match)"},
      {signal_u + "reaction = \"2 * (1 - u\"",
       "2: signal.u.reaction: cannot be read: missing parenthesis; write one expression, such as \"k * u * (1 - u)\""},
      {signal_u + "reaction = \"u = 3\"",
       "2: signal.u.reaction: assigns a value with \"=\"; write one expression, such as \"k * u * (1 - u)\""},
      {signal_u + "reaction = \"u, 3\"",
       "2: signal.u.reaction: has 2 expressions instead of one; write one expression, such as \"k * u * (1 - u)\""},
      {signal_u + "constants = { k = 1 }",
       "2: signal.u.constants: is not used without `reaction`; remove it, or set reaction"},
      {signal_u + "reaction = \"u\"\nconstants = { u = 1 }",
       "3: signal.u.constants: \"u\" is the name of a signal, a measure or a function; rename the constant"},
      {signal_u + "reaction = \"u\"\nconstants = { k = \"x\" }",
       "3: signal.u.constants: k: \"x\" has the wrong type; set constants to a table of numbers"},
      {signal_u + "initial = 1\ninitial_array = \"a\"",
       "3: signal.u.initial_array: conflicts with `initial`, which is also set; remove one of them"},
      {signal_u + pulling + "follow = { signal = \"v\", from = 0, to = 1 }",
       "5: cortex.a.follow.signal: no signal \"v\"; use one of: u"},
      {pulling + "follow = { signal = \"v\", from = 0, to = 1 }",
       "4: cortex.a.follow.signal: no signal \"v\"; add [signal.v]"},
      {signal_u + pulling + "follow = { signal = \"u\", measure = \"height_ratio\", from = 0, to = 1 }",
       "5: cortex.a.follow.signal: conflicts with `measure`, which is also set; remove one of them"},
      {signal_u + pulling + "follow = { signal = \"u\", from = 0 }",
       "5: cortex.a.follow.to: is missing; set `to` to the value at which the factor is 1"},
      {signal_u + pulling + "trigger = { signal = \"u\" }",
       "5: cortex.a.trigger.below: is missing; set either below or above"},
  };
  expect_errors(cases, load_errors);
  expect_errors({{signal_u + "initial_array = \"sna\"",
                  "2: signal.u.initial_array: the embryo has no array \"sna\"; set embryo.cell_arrays to a table with "
                  "this column, or use a file with this array"}},
                model_errors);
}

TEST(SignalKeys, MirrorPlanesNeedSymmetricSignals) {
  const std::string half = block_table(20, 20, 10, "2, 2, 1") + "mirror = [\"y\"]\n";
  expect_errors(
      {{half + signal_u + "initial = 1\ninitial_spread = 0.1",
        "9: signal.u.initial: is not symmetric: it is 0.9475 in cell 0 and 1.06 in its mirror image, cell 2; "
        "give symmetric values without initial_spread, or remove embryo.mirror"},
       {half + "[region.some]\nids = [0]\n" + signal_u + "source = { region = \"some\", per_min = 1 }",
        "11: signal.u.source: is not symmetric: it is 0.01667 in cell 0 and 0 in its mirror image, cell 2; give "
        "symmetric values without initial_spread, or remove embryo.mirror"}},
      side_errors);
}

TEST(SignalKeys, ConstantsAreReadPrintedAndOverridden) {
  const std::string text = signal_u + "reaction = \"k * u + b\"\nconstants = { k = 1, b = 0.25 }\n";
  const Scenario scenario = scenario_of(text, {"signal.u.constants.k=2"});
  EXPECT_EQ(scenario.signals.at("u").constants, (std::map<std::string, double>{{"b", 0.25}, {"k", 2}}));
  EXPECT_EQ(scenario_of(resolved_toml(scenario)).signals.at("u").constants, scenario.signals.at("u").constants);
}

}  // namespace
