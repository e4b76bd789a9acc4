// Rules of monitors, criteria and times.
#include <gtest/gtest.h>

#include <iostream>

#include "core/errors.hpp"
#include "scenario/load.hpp"
#include "scenario/print.hpp"
#include "scenario/validate.hpp"
#include "scenario/watch.hpp"
#include "support/scenarios.hpp"
#include "tissue/shapes/embryo.hpp"

namespace plica {
namespace {

using namespace support;

const std::string floor_monitor = "[monitor.floor]\nquantity = \"position\"\naxis = \"z\"\n";  // three lines

TEST(MonitorRules, EveryErrorIsOneLineWithARemedy) {
  const WrongScenarios cases = {
      {"[monitor.a]",
       "test.toml:1: monitor.a.quantity: is missing; set quantity to one of: position | displacement | speed | "
       "velocity | deviation | relative_energy_norm | surface_distance | force | volume | area | area_ratio | "
       "apical_elongation | pressure | kinetic_energy | time | wall"},
      {"[monitor.a]\nquantity = \"speed\"\nregion = \"al\"",
       "test.toml:3: monitor.a.region: region \"al\" does not exist; use \"all\" (nearest match)"},
      {"[monitor.a]\nquantity = \"position\"",
       "test.toml:1: monitor.a.axis: is missing; set axis to \"x\", \"y\" or \"z\""},
      {"[monitor.a]\nquantity = \"speed\"\naxis = \"z\"",
       "test.toml:3: monitor.a.axis: is not used with quantity \"speed\"; remove axis, or set quantity to "
       "\"velocity\""},
      {"[monitor.a]\nquantity = \"volume\"\nface = \"apical\"",
       "test.toml:3: monitor.a.face: is not used with quantity \"volume\"; remove face"},
      {"[monitor.a]\nquantity = \"time\"\nover = \"max\"",
       "test.toml:3: monitor.a.over: is not used with quantity \"time\"; remove over, since the quantity has a single "
       "value"},
      {"[monitor.a]\nquantity = \"deviation\"",
       "test.toml:1: monitor.a.reference: is missing; set reference to the results directory of a run"},
      {"[monitor.a]\nquantity = \"surface_distance\"",
       "test.toml:1: monitor.a.reference: is missing; set reference to a mesh file"},
      {"[monitor.a]\nquantity = \"speed\"\nreference = \"b\"",
       "test.toml:3: monitor.a.reference: is not used with quantity \"speed\"; remove reference"},
      {"[monitor.a]\nquantity = \"surface_distance\"\nreference = \"b\"\nreference_at = \"end\"",
       "test.toml:4: monitor.a.reference_at: is not used with quantity \"surface_distance\"; remove reference_at"},
      {"[monitor.a]\nquantity = \"kinetic_energy\"",
       "test.toml:2: monitor.a.quantity: kinetic energy requires a density above 0; set dynamics.density_kg_per_m3, or "
       "set quantity to \"speed\""},
      {"[volume]\nmethod = \"none\"\n[monitor.a]\nquantity = \"pressure\"",
       "test.toml:4: monitor.a.quantity: cell pressure requires conserved cell volumes; set volume.method to "
       "\"coupled\""},
      // Criteria.
      {"[stop.a]\nabove = 1", "test.toml:1: stop.a.monitor: is missing; set monitor to a text"},
      {floor_monitor + "[stop.a]\nmonitor = \"floor\"", "test.toml:4: stop.a: has no bound; set above or below"},
      {"[stop.a]",
       "test.toml:1: stop.a.monitor: is missing; set monitor to a text\ntest.toml:1: stop.a: has no bound; set above "
       "or below"},
      {floor_monitor + "[stop.a]\nmonitor = \"flor\"\nabove = 1",
       "test.toml:5: stop.a.monitor: monitor \"flor\" does not exist; use \"floor\" (nearest match)"},
      {"[stop.a]\nmonitor = \"floor\"\nabove = 1",
       "test.toml:2: stop.a.monitor: monitor \"floor\" does not exist; define [monitor.floor]"},
      {floor_monitor + "[stop.a]\nmonitor = \"floor\"\nabove = 3\nbelow = 3",
       "test.toml:6: stop.a.above: no value lies above 3 and below 3; reduce above, or define two criteria"},
      {floor_monitor + "[stop.equilibrium]\nmonitor = \"floor\"\nabove = 3",
       "test.toml:4: stop.equilibrium: \"equilibrium\" is a predefined criterion; rename the table, or set "
       "stop.equilibrium_speed_um_per_min"},
      {"[monitor.t]\nquantity = \"time\"\n[stop.a]\nmonitor = \"t\"\nabove = 3\nover = \"any\"",
       "test.toml:6: stop.a.over: monitor \"t\" has a single value; remove over"},
      // Expectations of monitors.
      {floor_monitor + "[expect]\nfloor.position_m = { value = 1, within = 1 }",
       "test.toml:5: expect.floor.position_m: no monitor has this name; use \"floor.position_um\" (nearest match)"},
      {"[expect]\n\"floor.position_um\" = { value = 1, within = 1 }",
       "test.toml:2: expect.floor.position_um: no monitor has this name; define the monitor as [monitor.NAME]"},
      {floor_monitor + "[expect]\nfloor.position_um = { value = 1 }",
       "test.toml:5: expect.floor.position_um: has no tolerance; set within or within_percent"},
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

TEST(Watch, MakesMonitorsAndCriteriaOfAScenario) {
  Tissue tissue = build_shell({.length_um = 460, .cells = {18, 9, 8}});
  tissue.regions["belly"] = tissue.regions.at("all");
  const Watch watch = make_watch(scenario_of(rich), Model(tissue));
  ASSERT_EQ(watch.monitors.size(), 2U);
  EXPECT_EQ(watch.monitors[0].column(), "clock.time_s");
  EXPECT_EQ(watch.monitors[1].column(), "floor.position_um");
  EXPECT_EQ(watch.monitors[1].axis, 2);
  EXPECT_EQ(watch.monitors[1].over, Over::max);
  EXPECT_EQ(watch.monitors[1].face, Monitor::Face::apical);
  EXPECT_TRUE(watch.stop.all);
  EXPECT_FALSE(watch.stop.needs_rest);
  ASSERT_EQ(watch.stop.criteria.size(), 2U);
  EXPECT_EQ(watch.stop.criteria[0].monitor, 1U);  // deep is on floor
  EXPECT_EQ(watch.stop.criteria[0].over, Criterion::Over::any);
  EXPECT_EQ(watch.stop.criteria[1].monitor, 0U);  // late on clock
  EXPECT_EQ(watch.stop.criteria[1].above, 60);
}

std::string error_of(const std::string& override_text) {
  return errors_in([&] {
    return load_scenario(find_scenario("drosophila"),
                         std::vector<std::string>{override_text, "contraction.apical.program.activity=[1, 1, 0]"});
  });
}

TEST(TimeRules, AProgramMayJumpButNotTwiceAtOnce) {
  EXPECT_EQ(error_of("contraction.apical.program.time_s=[0, 10, 10]"), "");
  EXPECT_NE(error_of("contraction.apical.program.time_s=[10, 10, 10]").find("10 occurs three times"),
            std::string::npos);
  EXPECT_NE(error_of("contraction.apical.program.time_s=[0, 10, 10.0000001]").find("closer than 1e-06 s"),
            std::string::npos);
  EXPECT_NE(error_of("contraction.apical.program.time_s=[0, 10, 9]").find("do not increase"), std::string::npos);
}

TEST(TimeRules, ARunLastsLongerThanAnInstant) {
  const auto ends_at = [](const char* end) {
    return load_scenario(find_scenario("drosophila"), std::vector<std::string>{std::string("time.end_s=") + end});
  };
  EXPECT_THROW(ends_at("1e-7"), ScenarioError);
  EXPECT_NO_THROW(ends_at("1e-5"));
}

}  // namespace
}  // namespace plica
