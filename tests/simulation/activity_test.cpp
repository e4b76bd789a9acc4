// Cells that are told from outside how active to be (Simulation::set_activity).
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "mechanics/active/given_activities.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

namespace plica {
namespace {

constexpr double as_programmed = GivenActivities::as_programmed;

Scenario block_with(const std::string& tables, const std::vector<std::string>& overrides = {}) {
  return load_scenario({"block", "block",
                        "[embryo]\nshape = \"block\"\nlength_um = 100\nwidth_um = 60\ncells = [5, 3, 1]\n"
                        "[vitelline]\nenabled = false\n[time]\nend_min = 2\n[stop]\nat_equilibrium = false\n"
                        "[region.middle]\nx_um = [-30, 30]\n" +
                            tables},
                       overrides);
}

const std::string springs = "[contraction.apical]\nregion = \"middle\"\nstiffness_nN_per_um = 3\n";
const std::string cortex =
    "[cortex.apical]\nregion = \"middle\"\ntension_mN_per_m = 1\nstiffness_mN_per_m = 1\n"
    "relaxation_s = 60\n";

double farthest(const Simulation& a, const Simulation& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.state().positions.size(); ++n)
    most = std::max(most, (a.state().positions[n] - b.state().positions[n]).norm());
  return most;
}

std::vector<double> all(const Simulation& simulation, double activity) {
  return std::vector<double>(simulation.model().tissue.cells.size(), activity);
}

TEST(GivenActivity, OfOneIsTheProgramOfOne) {
  for (const std::string& tables : {springs, cortex}) {
    const std::string label = (tables == springs ? "contraction" : "cortex") + std::string(".apical");
    Simulation programmed(block_with(tables)), told(block_with(tables)), freed(block_with(tables));
    told.set_activity(label, all(told, 1));
    freed.set_activity(label, all(freed, 0.3));
    freed.set_activity(label, {});
    for (Simulation* simulation : {&programmed, &told, &freed}) simulation->run_until(60);
    EXPECT_EQ(farthest(programmed, told), 0) << label;
    EXPECT_EQ(farthest(programmed, freed), 0) << label;
  }
}

TEST(GivenActivity, OfZeroIsNoContraction) {
  Simulation told(block_with(springs)), none(block_with(springs, {"contraction.apical.stiffness_nN_per_um=0"}));
  told.set_activity("contraction.apical", all(told, 0));
  EXPECT_EQ(told.run(), RunStatus::end_time);
  none.run();
  EXPECT_LE(farthest(told, none), 1e-12);
}

TEST(GivenActivity, IsOfSingleCellsAndIsMeasured) {
  Simulation simulation(block_with(springs));
  std::vector<double> activities = all(simulation, as_programmed);
  activities[7] = 0.25;
  simulation.set_activity("contraction.apical", activities);
  const Law& law = *simulation.model().laws[2];
  ASSERT_EQ(law.label(), "contraction.apical");
  const auto& internal = simulation.state().internals[2];
  EXPECT_EQ(law.activity_of(CellId(7), 0, internal), 0.25);
  EXPECT_EQ(law.activity_of(CellId(6), 0, internal), 1);
  EXPECT_EQ(law.activity_of(CellId(0), 0, internal), std::nullopt);  // not of the region
}

TEST(GivenActivity, GoesAlongIntoCopiesAndCheckpoints) {
  const Scenario scenario = block_with(cortex);
  Simulation first(scenario);
  first.run_until(20);
  first.set_activity("cortex.apical", all(first, 0.4));
  first.step();
  Simulation copy = first, resumed(scenario);
  resumed.go_on_from(first.memory(), first.measures());
  for (Simulation* simulation : {&first, &copy, &resumed}) simulation->run_until(80);
  EXPECT_EQ(farthest(first, copy), 0);
  EXPECT_EQ(farthest(first, resumed), 0);
}

TEST(GivenActivity, OfAMotherIsHerDaughters) {
  const Scenario scenario = block_with(springs + "[division.all]\nregion = \"middle\"\nat_min = 0.5\n");
  Simulation simulation(scenario);
  simulation.set_activity("contraction.apical", all(simulation, 0.6));
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  ASSERT_GT(simulation.divisions(), 0);
  const Model& model = simulation.model();
  const std::size_t law = place_of_law(model, "contraction.apical", true);
  for (std::size_t c = 0; c < model.tissue.cells.size(); ++c)
    if (model.tissue.regions.at("middle")[c]) {
      EXPECT_EQ(model.laws[law]->activity_of(CellId(c), simulation.time_s(), simulation.state().internals[law]), 0.6);
    }
}

TEST(GivenActivity, OfOneSideIsThatOfTheWhole) {
  const auto embryo = [](const std::vector<std::string>& more) {
    std::vector<std::string> overrides = {"time.end_min=1", "embryo.cells=[8,4,4]", "region.furrow.cells_along=4",
                                          "region.furrow.cells_across=2"};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return load_scenario(find_scenario("drosophila"), overrides);
  };
  Simulation whole(embryo({})), half(embryo({"embryo.mirror=[\"y\"]"}));
  for (Simulation* simulation : {&whole, &half}) {
    std::vector<double> activities;
    for (const Cell& cell : simulation->model().tissue.cells)
      activities.push_back(cell_centre(cell, simulation->model().tissue.rest_positions).x() > 0 ? 0.5 : 1.5);
    simulation->set_activity("contraction.apical", activities);
    simulation->run_until(30);
  }
  EXPECT_LE(farthest(whole, half), 0.01);
  std::vector<double> uneven = all(half, 1);
  uneven[0] = 0.5;
  EXPECT_THROW(half.set_activity("contraction.apical", uneven), UsageError);
}

TEST(GivenActivity, IsCheckedAndWakesWhatIsAtRest) {
  Simulation simulation(block_with(springs, {"stop.at_equilibrium=true", "time.end_min=60"}));
  for (const auto& [label, activities] : std::vector<std::pair<std::string, std::vector<double>>>{
           {"contraction.basal", all(simulation, 1)},
           {"corotational", all(simulation, 1)},
           {"contraction.apical", {1, 1}},
           {"contraction.apical", all(simulation, -2)},
           {"contraction.apical", all(simulation, std::numeric_limits<double>::quiet_NaN())}})
    EXPECT_THROW(simulation.set_activity(label, activities), UsageError);
  ASSERT_EQ(simulation.run(), RunStatus::equilibrium);
  const Simulation rest = simulation;
  simulation.set_activity("contraction.apical", all(simulation, 0));
  EXPECT_EQ(simulation.run(), RunStatus::equilibrium);
  EXPECT_GT(farthest(rest, simulation), 0.1);
}

}  // namespace
}  // namespace plica
