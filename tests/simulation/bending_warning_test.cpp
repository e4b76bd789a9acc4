#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <regex>

#include "scenario/load.hpp"
#include "simulation/run_warnings.hpp"

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

double depth_of(const Simulation& simulation) { return simulation.measures()["furrow_depth_um"].value(); }

// The depth of a small sheet with free ends errs four to five times as much as its bending.
TEST(BendingWarning, SaysNoLessOfTheDepthThanFourLayersShow) {
  const std::string sheet = R"(format = 1
[embryo]
shape = "block"
length_um = 40
width_um = 60
cell_height_um = 15
cells = [4, 6, 1]
[region.stripe]
y_um = [-20, 20]
[furrow]
region = "stripe"
[elasticity]
corner_barrier_Pa = 100
[time]
end_min = 60
[stop]
equilibrium_speed_um_per_min = 0.05
)";
  const std::string fading = R"(
region = "stripe"
program = { time_min = [0, 2], activity = [0, 1] }
profile = { shape = "linear", half_width_um = 20 }
)";
  int cases = 0;
  for (const std::string load : {"[cortex.apical]\ntension_mN_per_m = 1.5\nsaturation_ratio = 0.3",
                                 "[contraction.apical]\ntension_mN_per_m = 1.2"}) {
    std::string warning;
    double depth[2];
    for (const int layers : {1, 4}) {
      const Scenario scenario = load_scenario({"stripe", "stripe.toml", sheet + load + fading},
                                              {"embryo.elements_per_cell=[1, 1, " + std::to_string(layers) + "]"});
      Simulation simulation(scenario);
      while (simulation.step()) {
      }
      EXPECT_EQ(simulation.status(), RunStatus::equilibrium) << simulation.failure();
      depth[layers / 4] = depth_of(simulation);
      if (layers == 1) warning = bending_warning(scenario, simulation);
    }
    std::smatch said;
    ASSERT_TRUE(std::regex_search(warning, said, std::regex("the depth by up to about ([0-9]+) %"))) << warning;
    std::printf("depth %.3f um with one layer, %.3f with four; %s\n", depth[0], depth[1], warning.c_str());
    EXPECT_GE(std::stod(said[1]), 100 * std::abs(depth[0] / depth[1] - 1)) << load;
    ++cases;
  }
  EXPECT_EQ(cases, 2);
}

}  // namespace
}  // namespace plica
