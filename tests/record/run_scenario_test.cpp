// Scenario of a run that is resumed.
#include "record/run_scenario.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include "core/files.hpp"
#include "scenario/load.hpp"

namespace plica {
namespace {

Scenario scenario_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return load_scenario({"test", "test.toml", text}, overrides);
}

// A run of an earlier version continues as it began.
TEST(RunScenario, StayAsARunBegan) {
  const std::filesystem::path folder =
      std::filesystem::path(testing::TempDir()) / ("plica_as_begun_" + std::to_string(::getpid()));
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const std::string text = "[embryo]\nshape = \"sheet\"\n";
  EXPECT_EQ(*as_begun(scenario_of(text), folder).elasticity.corner_barrier_Pa, 100);  // nothing is there yet
  write_file(folder / "scenario.toml",
             text + "[elasticity]\ncorner_barrier_Pa = 0\n[time]\nintegrator = \"backward-euler\"\n");
  const Scenario begun = as_begun(scenario_of(text), folder);
  EXPECT_EQ(*begun.elasticity.corner_barrier_Pa, 0);
  EXPECT_EQ(begun.time.integrator, "backward-euler");
  const Scenario given =
      as_begun(scenario_of(text, {"elasticity.corner_barrier_Pa=5", "time.integrator=bdf2"}), folder);
  EXPECT_EQ(*given.elasticity.corner_barrier_Pa, 5);
  EXPECT_EQ(given.time.integrator, "bdf2");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace plica
