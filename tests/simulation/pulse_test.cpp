// Activity that pulses, over a run: steps see it, shorter ones agree on it, and a run that is resumed goes on with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "measure/cells.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"

namespace plica {
namespace {

const std::string pulsing = R"(format = 1
[embryo]
length_um = 300
diameter_um = 160
cell_height_um = 30
cells = [8, 6, 6]
[region.belly]
face = "ventral"
cells_across = 4
[dynamics]
surface_drag_Pa_s_per_um = 20
[cortex.apical]
region = "belly"
tension_mN_per_m = 2
pulse = { period_s = 40, amplitude = 0.8, seed = 3 }
[contraction.walls]
region = "belly"
edges = "lateral"
stiffness_nN_per_um = 0.5
pulse = { period_s = 25, amplitude = 0.5, phase = "together" }
[time]
end_s = 60
)";

Scenario scenario_of(const std::vector<std::string>& overrides) {
  return load_scenario({"test", "test.toml", pulsing}, overrides);
}

Vectors end_of(const std::vector<std::string>& overrides) {
  Simulation simulation(scenario_of(overrides));
  EXPECT_EQ(simulation.run(), RunStatus::end_time);
  return simulation.state().positions;
}

double largest_difference(const Vectors& a, const Vectors& b) {
  double largest = 0;
  for (std::size_t n = 0; n < a.size(); ++n) largest = std::max(largest, (a[n] - b[n]).norm());
  return largest;
}

// Backward Euler errs in proportion to its step: half the step, half the difference.
TEST(Pulses, HalfTheStepHalvesTheError) {
  const std::string first_order = "time.integrator=backward-euler";
  const Vectors two = end_of({first_order, "time.step_s=2"}), one = end_of({first_order, "time.step_s=1"}),
                half = end_of({first_order, "time.step_s=0.5"});
  const double coarse = largest_difference(two, one), fine = largest_difference(one, half);
  EXPECT_GT(coarse, 0.01);
  EXPECT_NEAR(coarse / fine, 2, 0.3);
  // Adaptive steps agree within some times their tolerance.
  EXPECT_LT(largest_difference(end_of({"time.tolerance_um=0.005"}), half), 2 * fine + 0.1);
}

TEST(Pulses, StepsSeeThemAndTheRunGoesOn) {
  Simulation simulation(scenario_of({"stop.equilibrium_speed_um_per_min=1e6"}));
  double time_s = 0, longest = 0, least = 2, most = 0;
  while (simulation.step()) {
    longest = std::max(longest, simulation.state().time_s - std::exchange(time_s, simulation.state().time_s));
    const std::vector<double> activity = activities(simulation.model(), simulation.state());
    const std::vector<double> strength = strengths(simulation.model());
    const CellSet& belly = simulation.model().tissue.regions.at("belly");
    for (std::size_t c = 0; c < belly.size(); ++c) {
      EXPECT_EQ(strength[c], belly[c] ? 1 : 0);
      if (!belly[c]) continue;
      least = std::min(least, activity[c]);
      most = std::max(most, activity[c]);
    }
  }
  EXPECT_NEAR(time_s, 60, 1e-9);  // with a speed that everything is slower than it would have ended at once
  EXPECT_LE(longest, 25.0 / 12 + 1e-9);
  EXPECT_LT(least, 0.6);
  EXPECT_GT(most, 1.4);
}

TEST(Pulses, ResumedRunsGoOnToTheSameBits) {
  Simulation whole(scenario_of({}));
  whole.run_until(20);
  const RunMemory memory = whole.memory();
  const Observation measures = whole.measures();
  whole.run();
  Simulation rest(scenario_of({}));
  rest.go_on_from(memory, measures);
  rest.run();
  EXPECT_EQ(rest.state().positions, whole.state().positions);
  EXPECT_EQ(rest.state().internals, whole.state().internals);
}

}  // namespace
}  // namespace plica
