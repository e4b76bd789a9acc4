// Table of walls, and factors on their tensions that are set from outside.
#include "measure/walls.hpp"

#include "core/errors.hpp"
#include "core/threads.hpp"
#include "mechanics/active/cortex.hpp"
#include "simulation/simulation.hpp"
#include "support/ran.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"
#include "tissue/faces.hpp"

namespace {

const std::string lateral = "[cortex.lateral]\nregion = \"all\"\nfaces = \"lateral\"\ntension_mN_per_m = 0.5\n";

// Two cells of 20 x 30 x 40 um.
std::string pair_of_cells(const std::string& more = lateral, const std::string& elements = "[1, 1, 1]") {
  return "[embryo]\nshape = \"block\"\nlength_um = 40\nwidth_um = 30\ncell_height_um = 40\ncells = [2, 1, 1]\n"
         "elements_per_cell = " +
         elements + "\n[vitelline]\nenabled = false\n[time]\nend_s = 20\n[stop]\nat_equilibrium = false\n" + more;
}

std::vector<double> tensions_of(const Simulation& simulation) {
  std::vector<double> tensions;
  for (const MeasuredWall& wall : measured_walls(simulation.model(), simulation.state()))
    tensions.push_back(wall.tension);
  return tensions;
}

TEST(Walls, OfTwoCellsAreOneBetweenThemAndTheirRims) {
  for (const char* elements : {"[1, 1, 1]", "[2, 3, 2]"}) {
    const Simulation simulation(scenario_of(pair_of_cells(lateral, elements)));
    const std::vector<MeasuredWall> walls = measured_walls(simulation.model(), simulation.state());
    ASSERT_EQ(walls.size(), 3u);
    const auto expect = [&](std::size_t place, int cell, std::optional<CellId> other, double length_um) {
      EXPECT_EQ(walls[place].cell, CellId(cell));
      EXPECT_EQ(walls[place].other, other);
      EXPECT_NEAR(walls[place].length_um, length_um, 1e-12);
      EXPECT_NEAR(walls[place].area_um2, 40 * length_um, 1e-11);
      EXPECT_NEAR(walls[place].tension, 0.5, 1e-12);
    };
    expect(0, 0, std::nullopt, 70);
    expect(1, 0, CellId(1), 30);
    expect(2, 1, std::nullopt, 70);
  }
}

TEST(Walls, HaveTheSumOfAllLateralTensions) {
  const Simulation simulation(scenario_of(pair_of_cells(
      lateral +
      "[region.left]\nids = [0]\n[cortex.more]\nregion = \"left\"\nfaces = \"lateral\"\ntension_mN_per_m = "
      "0.2\n[cortex.apical]\nregion = \"all\"\ntension_mN_per_m = 3\n")));
  const std::vector<double> tensions = tensions_of(simulation);
  EXPECT_NEAR(tensions[0], 0.7, 1e-12);
  EXPECT_NEAR(tensions[1], 0.6, 1e-12);
  EXPECT_NEAR(tensions[2], 0.5, 1e-12);
}

TEST(Walls, PullByTheirFactors) {
  Simulation simulation(scenario_of(pair_of_cells())), weak(scenario_of(pair_of_cells())),
      ones(scenario_of(pair_of_cells())), freed(scenario_of(pair_of_cells()));
  const Simulation before = simulation;
  simulation.set_wall_factors("cortex.lateral", std::vector<double>{1, 3, 0.5});
  const std::vector<double> tensions = tensions_of(simulation), expected = {0.5, 1.5, 0.25};
  for (std::size_t w = 0; w < expected.size(); ++w) EXPECT_NEAR(tensions[w], expected[w], 1e-12);
  EXPECT_EQ(wall_factors(simulation.model(), simulation.state(), "cortex.lateral"), (std::vector<double>{1, 3, 0.5}));
  ones.set_wall_factors("cortex.lateral", std::vector<double>{1, 1, 1});
  freed.set_wall_factors("cortex.lateral", std::vector<double>{2, 2, 2});
  freed.set_wall_factors("cortex.lateral", {});
  Simulation none = before;
  for (Simulation* one : {&simulation, &ones, &freed, &none}) one->run();
  EXPECT_EQ(ones.state().positions, none.state().positions);
  EXPECT_EQ(freed.state().positions, none.state().positions);
  const auto area = [](const Simulation& of) { return measured_walls(of.model(), of.state())[1].area_um2; };
  EXPECT_LT(area(simulation), area(none) - 0.1);
}

// Factors of both laws in one internal state: activities are set, and freed, beside factors.
TEST(Walls, KeepTheirFactorsBesideActivities) {
  Simulation simulation(scenario_of(pair_of_cells()));
  const auto expect = [&](double first, double second) {
    EXPECT_NEAR(tensions_of(simulation)[0], first, 1e-15);
    EXPECT_NEAR(tensions_of(simulation)[1], second, 1e-15);
  };
  simulation.set_activity("cortex.lateral", {0.2, 0.4});
  simulation.set_wall_factors("cortex.lateral", std::vector<double>{1, 3, 1});
  expect(0.1, 0.45);
  simulation.set_activity("cortex.lateral", {});
  expect(0.5, 1.5);
  simulation.set_activity("cortex.lateral", {0, 1});
  simulation.step();
  expect(0, 0.75);
  simulation.set_wall_factors("cortex.lateral", {});
  expect(0, 0.25);
}

// Daughters of cell 1 (of three in a row) are neighbours of 0 and 2 as their mother was.
TEST(Walls, OfDaughtersHaveTheFactorsOfTheirMother) {
  Simulation simulation(scenario_of(
      "[embryo]\nshape = \"block\"\nlength_um = 60\nwidth_um = 20\ncells = [3, 1, 1]\n[vitelline]\nenabled = "
      "false\n[region.middle]\nids = [1]\n[division.middle]\nregion = \"middle\"\nplane = \"sagittal\"\nat_s = "
      "2\n[time]\nend_s = 4\n" +
      lateral));
  std::vector<double> factors;
  for (const MeasuredWall& wall : measured_walls(simulation.model(), simulation.state()))
    factors.push_back(wall.other ? 2 + wall.cell.number() : 0.5);
  simulation.set_wall_factors("cortex.lateral", factors);
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  ASSERT_EQ(simulation.divisions(), 1);
  const std::vector<MeasuredWall> walls = measured_walls(simulation.model(), simulation.state());
  const std::vector<double> after = wall_factors(simulation.model(), simulation.state(), "cortex.lateral");
  int checked = 0;
  for (std::size_t w = 0; w < walls.size(); ++w, ++checked) {
    const int cell = walls[w].cell.number(), other = walls[w].other ? walls[w].other->number() : -1;
    const double expected = other < 0 ? 0.5 : cell == 0 ? 2 : cell == 2 || other == 2 ? 3 : 1;  // 1: between daughters
    EXPECT_NEAR(after[w], expected, 1e-12) << cell << " and " << other;
  }
  EXPECT_EQ(checked, 9);  // four rims, two walls to 0, two to 2, one between
}

using PairOfCells = std::pair<CellId, std::optional<CellId>>;

std::map<PairOfCells, double> factors_of(const Simulation& simulation) {
  const std::vector<MeasuredWall> walls = measured_walls(simulation.model(), simulation.state());
  const std::vector<double> factors = wall_factors(simulation.model(), simulation.state(), "cortex.lateral");
  std::map<PairOfCells, double> result;
  for (std::size_t w = 0; w < walls.size(); ++w) result[{walls[w].cell, walls[w].other}] = factors[w];
  return result;
}

// Pairs that stay keep their factors, pairs that meet begin with 1; from a checkpoint and on three threads the run
// continues to the same numbers.
TEST(Walls, KeepFactorsByPairsOfCellsThroughExchanges) {
  Simulation simulation(scenario_of(exchanging_sheet));
  std::vector<double> factors;
  Random random(5);
  while (factors.size() < measured_walls(simulation.model(), simulation.state()).size())
    factors.push_back(1 + random.number(0.5));
  simulation.set_wall_factors("cortex.lateral", factors);
  const auto first = factors_of(simulation);
  simulation.run_until(60);
  const RunMemory memory = simulation.memory();
  ASSERT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  ASSERT_GT(simulation.state().exchanges.count, 3);
  int kept = 0, met = 0;
  for (const auto& [pair, factor] : factors_of(simulation)) {
    const bool was_there = first.contains(pair);
    EXPECT_NEAR(factor, was_there && factor != 1 ? first.at(pair) : 1, 1e-12);  // 1: also if they have met again
    ++(was_there ? kept : met);
  }
  EXPECT_GT(kept, 60);
  EXPECT_GT(met, 1);
  const ThreadCount scope(3);
  Simulation fresh(scenario_of(exchanging_sheet));
  go_on_by_bytes(fresh, memory);
  fresh.run();
  expect_same(fresh.state(), simulation.state());
}

TEST(Walls, TakeNoFactorsThatMeanNothing) {
  Simulation simulation(
      scenario_of(pair_of_cells(lateral + "[cortex.apical]\nregion = \"all\"\ntension_mN_per_m = 1\n")));
  const auto refused = [&](const std::string& law, const std::vector<double>& factors) {
    return error_of<UsageError>([&] { simulation.set_wall_factors(law, factors); });
  };
  EXPECT_SAYS(refused("cortex.apical", {1, 1, 1}), "does not act on lateral faces");
  EXPECT_SAYS(refused("cortex.other", {1, 1, 1}), "cortex.lateral");
  EXPECT_SAYS(refused("cortex.lateral", {1, 1}), "2 factors for 3 walls");
  EXPECT_SAYS(refused("cortex.lateral", {1, -1, 1}), "the factor of wall 1 (cells 0 and 1) is -1");
  EXPECT_SAYS(refused("cortex.lateral", {1, 1, std::nan("")}), "is nan");
  Simulation half(load_scenario(
      find_scenario("drosophila"),
      {"embryo.cells=[8,4,4]", "embryo.mirror=[\"y\"]", "region.furrow.cells_along=4", "region.furrow.cells_across=2",
       "cortex.walls.region=all", "cortex.walls.faces=lateral", "cortex.walls.tension_mN_per_m=1"}));
  const std::size_t walls = measured_walls(half.model(), half.state()).size();
  EXPECT_SAYS(error_of<UsageError>([&] { half.set_wall_factors("cortex.walls", std::vector<double>(walls, 2)); }),
              "remove embryo.mirror");
  // A damaged checkpoint.
  simulation.set_wall_factors("cortex.lateral", std::vector<double>{1, 2, 3});
  RunMemory memory = simulation.memory();
  memory.state.internals[place_of_law(simulation.model(), "cortex.lateral")].pop_back();
  Simulation fresh(simulation);
  EXPECT_SAYS(error_of<UnfitMemory>([&] { fresh.go_on_from(memory); }), "internal state of cortex.lateral");
}

}  // namespace
