// Values that a scenario leaves to the program: the inversion barrier and the order in time.
#include <gtest/gtest.h>

#include "scenario/load.hpp"
#include "scenario/print.hpp"

namespace plica {
namespace {

using Overrides = std::vector<std::string>;

Scenario scenario_of(const std::string& text, const Overrides& overrides = {}) {
  return load_scenario({"test", "test.toml", text}, overrides);
}

double barrier_Pa(const std::string& text, const Overrides& overrides = {}) {
  return *scenario_of(text, overrides).elasticity.corner_barrier_Pa;
}

const std::string row = "[embryo]\nshape = \"block\"\ncells = [3, 1, 1]\n";
const std::string cut = "[division.cut]\nregion = \"all\"\nat_s = 5\n";

TEST(AutomaticBarrier, IsATenthOfYoungsModulusWhereCellsArePolygonsOrDivide) {
  for (const char* shape :
       {"egg", "sheet", "points\"\nfile = \"p.csv", "surface\"\nfile = \"s.obj", "file\"\nfile = \"m.vtu"}) {
    const std::string text = "[embryo]\nshape = \"" + std::string(shape) + "\"\n";
    EXPECT_EQ(barrier_Pa(text), 100) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\nyoung_modulus_Pa = 30\n"), 3) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\ncorner_barrier_Pa = 0\n"), 0) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\ncorner_barrier_Pa = 7\n"), 7) << shape;
    EXPECT_EQ(barrier_Pa(text + "[elasticity]\ncorner_barrier_Pa = 7\n", {"elasticity.corner_barrier_Pa=automatic"}),
              100)
        << shape;
  }
  EXPECT_EQ(barrier_Pa(row + cut), 100);
}

TEST(AutomaticBarrier, IsNoneOnGridsThatDoNotDivide) {
  for (const char* shape : {"pill", "sphere", "slice", "block"})
    EXPECT_EQ(barrier_Pa("[embryo]\nshape = \"" + std::string(shape) + "\"\n"), 0) << shape;
  EXPECT_EQ(barrier_Pa("base = \"drosophila\"\n"), 0);
  EXPECT_EQ(barrier_Pa("base = \"drosophila-living\"\n"), 10);
  // The paper's algorithm reproduces the paper.
  EXPECT_EQ(barrier_Pa("[embryo]\nshape = \"file\"\nfile = \"m.vtu\"\n[volume]\nmethod = \"projection\"\n"), 0);
}

TEST(AutomaticIntegrator, IsOfSecondOrderWhereItCanBe) {
  for (const char* shape : {"pill", "sphere", "slice", "block", "egg", "sheet"})
    EXPECT_EQ(scenario_of("[embryo]\nshape = \"" + std::string(shape) + "\"\n").time.integrator, "bdf2") << shape;
  for (const std::string bar :
       {"time.scheme=linearly-implicit", "volume.method=projection", "dynamics.density_kg_per_m3=1"}) {
    Overrides overrides = {bar};
    if (bar.starts_with("time")) overrides.emplace_back("volume.method=none");
    EXPECT_EQ(scenario_of(row, overrides).time.integrator, "backward-euler") << bar;
  }
  EXPECT_EQ(scenario_of(row, {"time.integrator=backward-euler"}).time.integrator, "backward-euler");
}

TEST(AutomaticValues, AreRecordedAsNumbers) {
  const std::string text = resolved_toml(scenario_of("[embryo]\nshape = \"sheet\"\n"));
  EXPECT_NE(text.find("\ncorner_barrier_Pa = 100\n"), std::string::npos) << text;
  EXPECT_EQ(text.find("integrator = \"automatic\""), std::string::npos) << text;
}

}  // namespace
}  // namespace plica
