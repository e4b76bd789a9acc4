// A constraint with a dense row: the volume inside the basal surface (the yolk's) is held; its multiplier is the
// pressure inside.
#include "mechanics/constraints/enclosed_volume.hpp"

#include <cmath>

#include "extensions/extension_checks.hpp"

namespace plica {
namespace {

using namespace support;

const Extension yolk = [](Model& model) {
  model.constraints.push_back(std::make_unique<EnclosedVolume>(model.tissue));
};

TEST(EnclosedVolume, IsHeldAsCellsAreAndThePressureIsNotNothing) {
  const auto at_end = [](const Extension& extension) {
    Simulation simulation(extended(extension, {"time.end_s=20"}));
    EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
    return simulation;
  };
  const Simulation held = at_end(yolk), free = at_end({});
  const auto ratio = [](const Simulation& simulation) { return simulation.measures()["lumen_volume_ratio"].value(); };
  EXPECT_NEAR(ratio(held), 1, 1e-9);
  EXPECT_GT(std::abs(ratio(free) - 1), 1e-3);
  EXPECT_GT(std::abs(held.state().multipliers.back()), 1e-6);
  EXPECT_LE(*held.measures()["max_volume_error"], 1e-9);
}

// What a dense row costs: one more solve each time, and no blocks. The shell is a little away, since with the lumen
// held in a sheet that lies on it nothing can move at first, and the constraints are nearly one.
TEST(EnclosedVolume, CostsFewIterationsMore) {
  for (const char* method : {"cholesky", "multigrid"}) {
    const auto iterations_a_direction = [&](const Extension& extension) {
      Simulation simulation(
          extended(extension, {"time.end_s=10", "vitelline.gap_um=0.5", std::string("time.linear_solver=") + method}));
      double linear = 0, newton = 0;
      while (simulation.step()) {
        linear += *simulation.measures()["linear_iterations"];
        newton += *simulation.measures()["newton_iterations"];
      }
      std::printf("%s: %d steps, %.0f Newton and %.0f linear iterations\n", method, simulation.steps(), newton, linear);
      return linear / newton;
    };
    EXPECT_LE(iterations_a_direction(yolk), 1.1 * iterations_a_direction({}));
  }
}

TEST(EnclosedVolume, WorksWithEveryLinearSolver) { expect_same_run_with_every_solver(yolk); }
TEST(EnclosedVolume, ResumesToTheSameBitsThroughADivision) {
  expect_resumable_through_a_division(yolk, "division.floor.daughter_volume_ratio=0.5");  // there is no room to grow
}
TEST(EnclosedVolume, IsRefusedByThePapersAlgorithm) {
  EXPECT_THROW(expect_runs_with_the_papers_algorithm(yolk), std::logic_error);
}

}  // namespace
}  // namespace plica
