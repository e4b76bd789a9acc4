// What every extension must do: run with each linear solver to the same end, go on from a checkpoint to the same bits
// through a division, and go with the paper's algorithm or be refused by it.
#pragma once

#include "scenario/load.hpp"
#include "support/law_checks.hpp"
#include "support/loads.hpp"
#include "support/models.hpp"
#include "support/resumed.hpp"

namespace plica::support {

/// Puts something into the model of a scenario.
using Extension = std::function<void(Model&)>;

/// The parts of a simulation of the Drosophila embryo with the extension.
inline Simulation::Parts extended(const Extension& extension, const std::vector<std::string>& overrides,
                                  const std::string& scenario = "drosophila") {
  Simulation::Parts parts = parts_of(load_scenario(find_scenario(scenario), overrides));
  if (extension) extension(*parts.model);
  return parts;
}

inline void expect_same_run_with_every_solver(const Extension& extension) {
  std::vector<Vectors> ends;
  for (const char* method : {"direct", "cholesky", "multigrid"}) {
    Simulation simulation(extended(extension, {"time.step_s=2", "time.end_s=10", "output.frame_every_s=0",
                                               std::string("time.linear_solver=") + method}));
    ASSERT_EQ(simulation.run(), RunStatus::end_time) << method << ": " << simulation.failure();
    ends.push_back(simulation.state().positions);
  }
  double apart = 0;
  for (const Vectors& end : ends) apart = std::max(apart, largest_distance(end, ends[0]));
  std::printf("direct, cholesky and multigrid end %.1e um apart\n", apart);
  EXPECT_LE(apart, 1e-6);
}

/// From every few steps on, by the bytes of a checkpoint where this plica has them.
inline void expect_resumable_through_a_division(const Extension& extension,
                                                const std::string& also = "output.frame_every_s=0") {
  const std::vector<std::string> overrides = {also, "division.floor.at_min=0.1", "division.floor.growth_min=0.2",
                                              "time.end_min=0.4", "time.integrator=\"bdf2\""};
  const auto fresh = [&] { return Simulation(extended(extension, overrides, "drosophila-division")); };
  std::vector<RunMemory> steps;
  Simulation whole = fresh();
  while (whole.step()) steps.push_back(whole.memory());
  ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  ASSERT_GT(whole.divisions(), 0);
  int resumed = 0;
  for (std::size_t k = 0; k < steps.size(); k += 7, ++resumed) {
    SCOPED_TRACE(testing::Message() << "from step " << k + 1 << " of " << steps.size());
    Simulation rest = fresh();
    go_on_by_bytes(rest, steps[k]);
    while (rest.step()) (void)rest.memory();  // drops its factor, as in the whole run
    EXPECT_EQ(rest.status(), whole.status());
    EXPECT_EQ(rest.steps(), whole.steps());
    expect_same(rest.state(), whole.state());
    ASSERT_FALSE(testing::Test::HasFailure());
  }
  EXPECT_GT(resumed, 3);
}

inline void expect_runs_with_the_papers_algorithm(const Extension& extension) {
  Simulation simulation(extended(extension, {"time.end_s=40"}, "drosophila-paper"));
  EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
}

}  // namespace plica::support
