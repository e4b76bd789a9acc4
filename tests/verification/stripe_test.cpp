// A stripe that bends a sheet: depth does not depend on how cells are divided into elements.
#include <gtest/gtest.h>

#include <cstdio>

#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

namespace plica {
namespace {

const std::string sheet = R"(format = 1
[embryo]
shape = "sheet"
periodic = ["x"]
length_um = 30
width_um = 70
cell_count = 84
cell_height_um = 15
[region.stripe]
y_um = [-15, 15]
[furrow]
region = "stripe"
[elasticity]
corner_barrier_Pa = 100
[time]
end_min = 30
[stop]
equilibrium_speed_um_per_min = 0.05
)";
const std::string fading = R"(
region = "stripe"
program = { time_min = [0, 2], activity = [0, 1] }
profile = { shape = "linear", half_width_um = 15 }
)";

double depth_by(const std::string& load, const std::vector<std::string>& overrides) {
  Simulation simulation(load_scenario({"stripe", "stripe.toml", sheet + load + fading}, overrides));
  while (simulation.step()) {
  }
  EXPECT_EQ(simulation.status(), RunStatus::equilibrium) << simulation.failure();
  return simulation.measures()["furrow_depth_um"].value();
}

// Springs on edges only let the middles of kites buckle, and their dimples were the depth: 13 % more by springs, 9 % by
// a tension.
TEST(Stripe, IsAsDeepByKitesAsByDiagonals) {
  int cases = 0;
  for (const std::string load :
       {"[contraction.apical]\nstiffness_nN_per_um = 2", "[contraction.apical]\ntension_mN_per_m = 1.5",
        "[cortex.apical]\ntension_mN_per_m = 2\nsaturation_ratio = 0.3"}) {
    const double diagonals = depth_by(load, {}), kites = depth_by(load, {"embryo.elements=kites"});
    std::printf("%s: %.3f um by diagonals, %.3f by kites\n", load.c_str(), diagonals, kites);
    EXPECT_GT(diagonals, 1.5) << load;
    EXPECT_NEAR(kites, diagonals, 0.03 * diagonals) << load;
    ++cases;
  }
  EXPECT_EQ(cases, 3);
}

}  // namespace
}  // namespace plica
