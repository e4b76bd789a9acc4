#include "simulation/bending_warning.hpp"

#include <gtest/gtest.h>

#include "scenario/load.hpp"

namespace plica {
namespace {

const std::string strip = R"(format = 1
[region.stripe]
y_um = [-12, 12]
[contraction.apical]
region = "stripe"
stiffness_nN_per_um = 1.5
profile = { shape = "linear", half_width_um = 15 }
program = { time_min = [0, 3], activity = [0, 1] }
[elasticity]
corner_barrier_Pa = 100
[time]
integrator = "bdf2"
end_min = 8
[embryo]
length_um = 20
width_um = 60
cell_height_um = 12
)";

std::string warning_of(const std::string& shape, const std::vector<std::string>& overrides) {
  const Scenario scenario = load_scenario({"stripe", "stripe.toml", strip + shape}, overrides);
  Simulation simulation(scenario);
  while (simulation.step()) {
  }
  EXPECT_EQ(simulation.failure(), "");
  return bending_warning(scenario, simulation);
}

// The warning names a key of its scenario, which ends it.
TEST(BendingWarning, ItsRemedyWorks) {
  int cases = 0;
  for (const auto& [shape, named, remedy] :
       {std::tuple("shape = \"sheet\"\ncell_count = 48", "compare with embryo.layers = 2", "embryo.layers=2"),
        {"shape = \"block\"\ncells = [4, 12, 1]", "compare with embryo.elements_per_cell = [1, 1, 2]",
         "embryo.elements_per_cell=[1,1,2]"}}) {
    const std::string warning = warning_of(shape, {});
    EXPECT_NE(warning.find(named), std::string::npos) << warning;
    EXPECT_EQ(warning_of(shape, {remedy}), "");
    EXPECT_EQ(warning_of(shape, {"contraction.apical.stiffness_nN_per_um=0.2"}), "");
    ++cases;
  }
  EXPECT_EQ(cases, 2);
}

}  // namespace
}  // namespace plica
