#include <gtest/gtest.h>

#include "scenario/load.hpp"
#include "simulation/run_warnings.hpp"

namespace plica {
namespace {

// A stripe that contracts at once.
const std::string stripe = R"([embryo]
shape = "block"
cells = [2, 5, 1]
length_um = 16
width_um = 40
cell_height_um = 12
[region.stripe]
y_um = [-5, 5]
[contraction.apical]
region = "stripe"
stiffness_nN_per_um = 2
[dynamics]
surface_drag_Pa_s_per_um = 10
[time]
end_min = 10
)";
const std::string slowly = "contraction.apical.program={time_s=[0,10],activity=[0,1]}";

std::string warning_of(const std::vector<std::string>& overrides) {
  Simulation simulation(load_scenario({"test", "test.toml", stripe}, overrides));
  EXPECT_EQ(energy_warning(simulation), "");
  simulation.run();
  EXPECT_NE(simulation.status(), RunStatus::failed) << simulation.failure();
  return energy_warning(simulation);
}

// The keys that a warning says to set, as overrides.
std::vector<std::string> remedy_in(const std::string& warning) {
  std::vector<std::string> overrides;
  for (std::size_t at = warning.find("time."); at != std::string::npos; at = warning.find("time.", at + 1)) {
    std::string change = warning.substr(at, warning.find(" and ", at) - at);
    const std::size_t to = change.find(" to ");
    overrides.push_back(change.replace(to, 4, "="));
  }
  return overrides;
}

// Each remedy that a warning names is tried, and ends it.
TEST(EnergyWarning, NamesARemedyThatWorks) {
  using Texts = std::vector<std::string>;
  int cases = 0;
  for (const auto& [given, named] :
       {std::pair(Texts{"time.integrator=backward-euler"},
                  Texts{"time.first_step_s to ", "time.tolerance_um to ", "time.integrator to \"bdf2\""}),
        {{"time.integrator=bdf2"}, {"time.first_step_s to ", "time.tolerance_um to "}},
        {{"time.integrator=bdf2", "time.step_s=2"},
         {"time.step_s to \"adaptive\"", "time.first_step_s to ", "time.tolerance_um to "}},
        {{"time.integrator=backward-euler", "time.step_s=5", slowly},
         {"time.step_s to \"adaptive\"", "time.integrator to \"bdf2\""}},
        {{"time.integrator=bdf2", "time.tolerance_um=1", slowly}, {"time.tolerance_um to "}},
        {{"dynamics.density_kg_per_m3=1000", "time.integrator=backward-euler", "time.tolerance_um=4", slowly},
         {"time.tolerance_um to "}}}) {
    const std::string text = warning_of(given);
    for (const std::string& key : named) EXPECT_NE(text.find(key), std::string::npos) << text;
    const Texts remedy = remedy_in(text);
    EXPECT_EQ(remedy.size(), named.size()) << text;
    Texts changed = given;
    changed.insert(changed.end(), remedy.begin(), remedy.end());
    EXPECT_EQ(warning_of(changed), "") << text;
    ++cases;
  }
  EXPECT_EQ(cases, 6);
}

TEST(EnergyWarning, IsSilentWhereNothingIsWrong) {
  EXPECT_EQ(warning_of({"time.integrator=bdf2", slowly}), "");
  // The first steps weigh most in a run of few.
  EXPECT_EQ(warning_of({"time.integrator=bdf2", "time.end_s=0.3"}), "");
  // Projections do work that no law counts, at any step.
  EXPECT_EQ(warning_of({"time.integrator=backward-euler", "volume.method=projection", "time.step_s=2"}), "");
}

}  // namespace
}  // namespace plica
