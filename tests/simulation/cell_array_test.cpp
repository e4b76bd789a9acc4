// Arrays of cells that a program keeps in a simulation (Simulation::set_cell_array).
#include <gtest/gtest.h>

#include <limits>

#include "core/errors.hpp"
#include "record/checkpoint.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

namespace plica {
namespace {

Scenario row_of_cells(const std::string& more = "") {
  return load_scenario({"row", "row",
                        "[embryo]\nshape = \"block\"\nlength_um = 60\nwidth_um = 20\ncells = [3, 1, 1]\n"
                        "[region.middle]\nids = [1]\n[vitelline]\nenabled = false\n[time]\nend_s = 4\n" +
                            more});
}

TEST(CellArray, IsCopiedAndRemembered) {
  Simulation simulation(row_of_cells());
  simulation.set_cell_array("signal", {1, 2, 3});
  simulation.run_until(1);
  Simulation copy(simulation), resumed(row_of_cells());
  resumed.go_on_from(simulation.memory(), simulation.measures());
  for (const Simulation* one : {&copy, &resumed}) EXPECT_EQ(one->outside_arrays().at("signal"), (CellArray{1, 2, 3}));
  copy.set_cell_array("signal", {0, 0, 0});
  EXPECT_EQ(simulation.outside_arrays().at("signal"), (CellArray{1, 2, 3}));
}

TEST(CellArray, IsInheritedByDaughters) {
  Simulation simulation(row_of_cells("[division.middle]\nregion = \"middle\"\nplane = \"transverse\"\nat_s = 2\n"));
  simulation.set_cell_array("signal", {1, 2, 3});
  simulation.run();
  EXPECT_EQ(simulation.divisions(), 1);
  EXPECT_EQ(simulation.outside_arrays().at("signal"), (CellArray{1, 2, 3, 2}));
}

TEST(CellArray, ThatFitsNoCellIsRefused) {
  Simulation simulation(row_of_cells());
  const auto refused = [&](const std::string& name, const CellArray& values, const std::string& said) {
    try {
      simulation.set_cell_array(name, values);
      ADD_FAILURE() << name;
    } catch (const UsageError& error) {
      EXPECT_NE(std::string(error.what()).find(said), std::string::npos) << error.what();
    }
  };
  refused("signal", {1, 2}, "2 values for 3 cells");
  refused("signal", {1, 2, std::numeric_limits<double>::quiet_NaN()}, "the value of cell 2 is nan");
  refused("x_um", {1, 2, 3}, "is an output variable");
  refused("region_middle", {1, 2, 3}, "is an output variable");
  refused("a\nb", {1, 2, 3}, "control characters");
  EXPECT_TRUE(simulation.outside_arrays().empty());
  RunMemory memory = simulation.memory();
  memory.outside_arrays["signal"] = {1};
  EXPECT_THROW(simulation.go_on_from(memory, simulation.measures()), UnfitMemory);
}

}  // namespace
}  // namespace plica
