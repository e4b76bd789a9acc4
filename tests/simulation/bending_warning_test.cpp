#include "simulation/bending_warning.hpp"

#include <gtest/gtest.h>

#include "scenario/load.hpp"

namespace plica {
namespace {

// A stripe of a small sheet: the warning's remedy ends it.
TEST(BendingWarning, ItsRemedyWorks) {
  const auto warning_of = [](const std::vector<std::string>& overrides) {
    Simulation simulation(load_scenario({"stripe", "stripe.toml", R"(format = 1
[embryo]
shape = "sheet"
length_um = 20
width_um = 60
cell_count = 48
cell_height_um = 12
[region.stripe]
y_um = [-12, 12]
[contraction.apical]
region = "stripe"
stiffness_nN_per_um = 3
profile = { shape = "linear", half_width_um = 15 }
program = { time_min = [0, 3], activity = [0, 1] }
[elasticity]
corner_barrier_Pa = 100
[time]
integrator = "bdf2"
end_min = 8
)"},
                                        overrides));
    while (simulation.step()) {
    }
    EXPECT_EQ(simulation.failure(), "");
    return bending_warning(simulation);
  };
  const std::string warning = warning_of({});
  ASSERT_NE(warning.find("embryo.layers = 2"), std::string::npos) << warning;
  EXPECT_EQ(warning_of({"embryo.layers=2"}), "");
  EXPECT_EQ(warning_of({"contraction.apical.stiffness_nN_per_um=0.2"}), "");
}

}  // namespace
}  // namespace plica
