// Warnings during a run: bending, energy, pace.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <regex>

#include "scenario/load.hpp"
#include "simulation/pace.hpp"
#include "simulation/run_warnings.hpp"
#include "simulation/simulation.hpp"

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
  }
}

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

std::string energy_warning_of(const std::vector<std::string>& overrides) {
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
    const std::string text = energy_warning_of(given);
    for (const std::string& key : named) EXPECT_NE(text.find(key), std::string::npos) << text;
    const Texts remedy = remedy_in(text);
    EXPECT_EQ(remedy.size(), named.size()) << text;
    Texts changed = given;
    changed.insert(changed.end(), remedy.begin(), remedy.end());
    EXPECT_EQ(energy_warning_of(changed), "") << text;
    ++cases;
  }
  EXPECT_EQ(cases, 6);
}

TEST(EnergyWarning, IsSilentWhereNothingIsWrong) {
  EXPECT_EQ(energy_warning_of({"time.integrator=bdf2", slowly}), "");
  // The first steps weigh most in a run of few.
  EXPECT_EQ(energy_warning_of({"time.integrator=bdf2", "time.end_s=0.3"}), "");
  // Projections do work that no law counts, at any step.
  EXPECT_EQ(energy_warning_of({"time.integrator=backward-euler", "volume.method=projection", "time.step_s=2"}), "");
}

// Two layers of kites between fixed ends, whose lateral edges pull with a hundred times what the cells can carry.
Simulation crushed() {
  return Simulation(load_scenario({"crushed", "crushed.toml", R"([embryo]
shape = "sheet"
length_um = 15.51
width_um = 9.913
cell_count = 12
cell_height_um = 18.09
seed = 664
elements = "kites"
layers = 2
rim = "held"
[elasticity]
young_modulus_Pa = 130
[contraction.load]
region = "all"
edges = "lateral"
stiffness_nN_per_um = 20
program = { time_s = [0, 60], activity = [0, 1] }
[time]
end_s = 180
)"}));
}

TEST(Pace, ARunThatCrushesItsCellsEnds) {
  Simulation run = crushed();
  std::optional<RunMemory> halfway;
  while (run.step())
    if (!halfway && run.memory().pace.iterations > 200) halfway = run.memory();
  ASSERT_EQ(run.status(), RunStatus::failed);
  EXPECT_LT(run.steps(), 100);
  EXPECT_TRUE(run.failure().starts_with("forces crush cell " + std::to_string(run.failed_cell().value())))
      << run.failure();

  Simulation resumed = crushed();
  ASSERT_TRUE(halfway.has_value());
  resumed.go_on_from(*halfway, run.measures());
  resumed.run();
  EXPECT_EQ(resumed.failure(), run.failure());
  EXPECT_EQ(resumed.state().positions, run.state().positions);
}

class PaceRule : public testing::Test {
 protected:
  PaceRule() { at.time_s = 3, flatten(0.005); }
  // One corner of the first element, at this part of its reference Jacobian.
  void flatten(double ratio) {
    at.positions = model.tissue.rest_positions;
    const auto& element = model.tissue.elements.front();
    Vec3& corner = at.positions[element[0].index()];
    corner = ratio * corner + (1 - ratio) * at.positions[element[4].index()];
  }
  bool ends() const { return standstill(pace, controls, model, at).has_value(); }

  Simulation simulation{
      load_scenario({"block", "block.toml", "[embryo]\nshape = \"block\"\ncells = [2, 2, 1]\n[time]\nend_s = 180\n"})};
  const Model& model = simulation.model();
  State at = simulation.state();
  RunControls controls = simulation.controls();
  Pace pace{.since_s = 2, .steps = 60, .iterations = 300};
};

TEST_F(PaceRule, EndsWhereShortHardStepsFoldACrushedTissue) {
  EXPECT_TRUE(ends());
  controls.fixed_step_s = 0.1;
  EXPECT_TRUE(ends()) << "steps are halved";
}

TEST_F(PaceRule, SparesSlowButHealthyRuns) {
  flatten(0.02);
  EXPECT_FALSE(ends()) << "no corner is crushed";
  flatten(0.005);
  pace.steps = 61;
  EXPECT_FALSE(ends()) << "steps are easy";
  pace.steps = 60, pace.since_s = 0, at.time_s = 10;
  EXPECT_FALSE(ends()) << "steps are long";
  pace.since_s = 9, controls.fixed_step_s = 0.02;
  EXPECT_FALSE(ends()) << "steps are as long as requested";
}

}  // namespace
}  // namespace plica
