// A run that hardly advances because forces crush its cells ends, at the same step after a resumption; others do not.
#include "simulation/pace.hpp"

#include <gtest/gtest.h>

#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

namespace plica {
namespace {

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
