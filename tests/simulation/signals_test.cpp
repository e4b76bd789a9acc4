// Runs in which cells act by a signal: what they do, threads, resumption, divisions and mirror planes.
#include "core/threads.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"

namespace {

// A wave that goes through a sheet from its left end, behind which cells contract.
const std::string waving = "format = 1\n" + sheet_table(60, 40, 10, 48) + R"TOML(
[region.left]
length_percent = [0, 15]
[region.left-half]
length_percent = [0, 50]
[dynamics]
surface_drag_Pa_s_per_um = 30
[signal.u]
diffusion_um2_per_min = 60
decay_per_min = 0.05
source = { region = "left", per_min = 0.5 }
reaction = "k * u * v * (1 - u)"
constants = { k = 4 }
[signal.v]
initial = 1
initial_spread = 0.1
[cortex.apical]
region = "all"
tension_mN_per_m = 0.3
follow = { signal = "u", from = 0.2, to = 0.8 }
[cortex.walls]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.05
trigger = { signal = "u", above = 0.5 }
program = { time_min = [0, 1], activity = [0, 1] }
[time]
end_min = 4
[stop]
at_equilibrium = false
)TOML";
const std::string dividing = waving + "[division.a]\nregion = \"left-half\"\nat_min = 2\nplane = \"longest-axis\"\n";

double amount(const Simulation& run, std::size_t signal) {
  const std::vector<double> volumes = run.model().volumes.volumes(run.state().positions);
  double sum = 0;
  for (std::size_t c = 0; c < volumes.size(); ++c) sum += volumes[c] * run.state().signals[signal][c];
  return sum;
}

TEST(SignalRun, ActivitiesFollowASignalAndStartAtIt) {
  Simulation run(scenario_of(waving, {"time.end_min=2"}));
  const std::vector<std::string> labels = {"cortex.apical", "cortex.walls"};
  const auto activity = [&](std::size_t law, std::size_t cell) {
    const std::size_t place = place_of_law(run.model(), labels[law]);
    return *run.model().laws[place]->activity_of(CellId(cell), run.time_s(), run.state().internals[place]);
  };
  std::vector<double> start_s(48, -1);
  while (run.step())
    for (std::size_t c = 0; c < 48; ++c) {
      const double u = run.state().signals[0][c];
      EXPECT_NEAR(activity(0, c), std::clamp((u - 0.2) / 0.6, 0.0, 1.0), 1e-12);
      if (u > 0.5 && start_s[c] < 0) start_s[c] = run.time_s();
      const double expected = start_s[c] < 0 ? 0 : std::min(1.0, (run.time_s() - start_s[c]) / 60);
      EXPECT_NEAR(activity(1, c), expected, 1e-12);
    }
  ASSERT_EQ(run.status(), RunStatus::end_time) << run.failure();
  const auto started = std::ranges::count_if(start_s, [](double time) { return time >= 0; });
  EXPECT_GT(started, 10);
  EXPECT_LT(started, 48);
  EXPECT_NEAR(amount(run, 1), amount(Simulation(scenario_of(waving)), 1), 1e-9 * amount(run, 1));
}

TEST(SignalRun, IsTheSameForAnyThreadsAndAfterAResumption) {
  for (const std::string& text : {waving, dividing}) {
    const Scenario scenario = scenario_of(text);
    Simulation whole(scenario);
    std::optional<RunMemory> kept;
    {
      const ThreadCount one(1);
      while (whole.step())
        if (whole.time_s() > 130 && !kept) kept = whole.memory();
    }
    ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
    Simulation rest(scenario);
    go_on_by_bytes(rest, *kept);
    const ThreadCount several(3);
    rest.run();
    EXPECT_GT(whole.steps(), kept->steps);
    expect_same(rest.state(), whole.state());
    EXPECT_EQ(whole.divisions() > 0, text == dividing);
  }
}

TEST(SignalRun, ADivisionKeepsAmountsAndConcentrations) {
  Simulation run(scenario_of(dividing));
  struct Watch final : SimulationListener {
    void step_accepted(const AcceptedStep&, const Observation&) override {
      before = {amount(run, 0), amount(run, 1)}, values = run.state().signals;
    }
    void cells_divided(const TissueChange& change) override {
      for (const std::size_t s : {0, 1}) {
        EXPECT_NEAR(amount(run, s), before[s], 1e-12 * before[s]);
        for (std::size_t c = 0; c < change.origin.size(); ++c) {
          const double was = values[s][change.origin[c].index()];
          EXPECT_NEAR(run.state().signals[s][c], was, 0.01 * was);
        }
      }
      divided = true;
    }
    explicit Watch(const Simulation& simulation) : run(simulation) {}
    const Simulation& run;
    std::array<double, 2> before = {};
    Signals::Values values;
    bool divided = false;
  } watch(run);
  run.listen(watch);
  ASSERT_EQ(run.run(), RunStatus::end_time) << run.failure();
  EXPECT_TRUE(watch.divided);
}

TEST(SignalRun, AMirroredSheetHasTheSignalsOfTheWhole) {
  const std::string block = "format = 1\n" + block_table(80, 40, 10, "8, 4, 1") + waving.substr(waving.find("[region"));
  const std::string even = std::regex_replace(block, std::regex("initial_spread = 0.1"), "");
  Simulation whole(scenario_of(even)), side(scenario_of(even, {"embryo.mirror=[\"y\"]"}));
  ASSERT_EQ(whole.run(), RunStatus::end_time) << whole.failure();
  ASSERT_EQ(side.run(), RunStatus::end_time) << side.failure();
  ASSERT_EQ(side.state().signals[0].size(), 32u);
  for (std::size_t c = 0; c < 32; ++c) EXPECT_NEAR(side.state().signals[0][c], whole.state().signals[0][c], 2e-3);
  EXPECT_LT(largest_distance(side.state().positions, whole.state().positions), 0.05);
}

TEST(SignalRun, AFailureNamesCellSignalAndTime) {
  Simulation run(scenario_of(waving, {"signal.u.reaction=\"1 / (u - u)\"", "signal.u.constants={ k = 1 }"}));
  EXPECT_EQ(run.run(), RunStatus::failed);
  EXPECT_TRUE(run.failure().starts_with("the reaction of signal u is not finite in cell 0 at t = ")) << run.failure();
  EXPECT_EQ(run.failed_cell(), 0);
}

// A run is not at its end while a signal changes and nothing moves yet.
TEST(SignalRun, WaitsForSignalsBeforeItIsAtEquilibrium) {
  const std::string text = std::regex_replace(waving, std::regex("at_equilibrium = false"), "at_equilibrium = true");
  Simulation run(scenario_of(text, {"signal.u.source.per_min=0.02", "time.end_min=3"}));
  EXPECT_EQ(run.run(), RunStatus::end_time) << run.failure();
}

}  // namespace
