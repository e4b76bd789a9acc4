// A run that goes on from a memory of itself ends in the same bits as one that was never interrupted.
#include "core/threads.hpp"
#include "scenario/load.hpp"
#include "support/loads.hpp"
#include "support/resumed.hpp"
#include "support/roofs.hpp"
#include "support/scenarios.hpp"

namespace {

// What a run leaves behind: everything that happened after each step.
struct Trace {
  std::vector<RunMemory> memories;  // after each step
  RunStatus status;
  std::string failure;
  RunMemory end;
};

// Memories make the run forget its factor, but for those of resumable steps.
struct Tracer final : SimulationListener {
  Tracer(const Simulation& of, Trace& into) : simulation(of), trace(into) {}
  void step_accepted(const AcceptedStep& /*step*/, const Observation& /*measures*/) override {
    trace.memories.push_back(simulation.memory());
  }
  const Simulation& simulation;
  Trace& trace;
};

Trace trace(const std::string& name, const std::vector<std::string>& overrides, const Trace* before = nullptr,
            std::size_t step = 0) {
  Simulation simulation(load_scenario(find_scenario(name), overrides));
  if (before != nullptr) simulation.go_on_from(before->memories[step]);
  Trace trace;
  Tracer tracer(simulation, trace);
  simulation.listen(tracer);
  trace.status = simulation.run();
  trace.failure = simulation.failure();
  trace.end = simulation.memory();
  return trace;
}

// Goes on from every `every`th step of the run.
void expect_resumable(const std::string& name, const std::vector<std::string>& overrides, std::size_t every) {
  const Trace whole = trace(name, overrides);
  ASSERT_GT(whole.memories.size(), every);
  for (std::size_t k = 0; k < whole.memories.size(); k += every) {
    SCOPED_TRACE(testing::Message() << name << " from step " << k + 1 << " of " << whole.memories.size());
    const Trace rest = trace(name, overrides, &whole, k);
    ASSERT_EQ(rest.memories.size(), whole.memories.size() - k - 1);
    for (std::size_t i = 0; i < rest.memories.size(); ++i) {
      expect_same(rest.memories[i].state, whole.memories[k + 1 + i].state);
      EXPECT_EQ(rest.memories[i].steps, whole.memories[k + 1 + i].steps);
      ASSERT_FALSE(testing::Test::HasFailure()) << "at step " << k + 2 + i;
    }
    expect_same(rest.end.state, whole.end.state);
    EXPECT_EQ(rest.status, whole.status);
    EXPECT_EQ(rest.end.equilibrium_time_s, whole.end.equilibrium_time_s);
    EXPECT_EQ(rest.end.divisions, whole.end.divisions);
  }
}

const std::string euler = "time.integrator=\"backward-euler\"", bdf2 = "time.integrator=\"bdf2\"";

TEST(Resume, GoesOnToTheSameBits) { expect_resumable("drosophila", {"time.end_min=2", bdf2}, 13); }

TEST(Resume, WithFirstOrder) { expect_resumable("drosophila", {"time.end_min=1", euler}, 13); }

TEST(Resume, WithAnotherOrder) {
  const std::vector<std::string> first = {"time.end_s=6", euler}, second = {"time.end_s=6", bdf2};
  const Trace of_first = trace("drosophila", first), of_second = trace("drosophila", second);
  const auto half = [](const Trace& whole) { return whole.memories.size() / 2; };
  for (const Trace& changed : {trace("drosophila", second, &of_first, half(of_first)),
                               trace("drosophila", first, &of_second, half(of_second))}) {
    EXPECT_EQ(changed.status, RunStatus::end_time) << changed.failure;
    const double apart = largest_distance(changed.end.state.positions, of_second.end.state.positions);
    EXPECT_LT(apart, 0.3) << "backward Euler alone is off by as much";
    EXPECT_GT(apart, 1e-6) << "it went on with the order of before";
  }
}

TEST(Resume, WithTheDirectMethod) {
  expect_resumable("drosophila", {"time.end_s=3", "time.linear_solver=\"direct\""}, 4);
}

TEST(Resume, WithMultigrid) { expect_resumable("drosophila", {"time.end_s=2", "time.linear_solver=\"multigrid\""}, 5); }

TEST(Resume, WithThePapersAlgorithm) { expect_resumable("drosophila-paper", {"time.end_s=40"}, 3); }

TEST(Resume, WithShapeMemory) { expect_resumable("drosophila-shape-memory", {"time.end_s=5"}, 9); }

// Rest shapes that flow.
const std::string flowing = "elasticity.relaxation_min=1", neo_hookean = "elasticity.model=\"neo-hookean\"";

TEST(Resume, WithCellsThatFlow) {
  expect_resumable("furrow-slice", {"time.end_min=3", neo_hookean, flowing}, 7);
  expect_resumable("drosophila", {"time.end_s=10", neo_hookean, flowing, euler}, 5);
}

TEST(Resume, WithCellsThatFlowAcrossDivisions) {
  expect_resumable("drosophila-division-twice",
                   {"division.floor.at_min=0.2", "division.floor.growth_min=0.3", "division.borders.at_min=0.5",
                    "time.end_min=0.7", bdf2, neo_hookean, flowing},
                   11);
}

// Two roofs that only their edges keep apart: on three threads, from a memory, and by the bytes of a checkpoint.
TEST(Resume, WithEdgesThatPress) {
  const auto fresh = [] {
    Roofs roofs(0.5);
    // So many elements beside them that threads share the loops.
    roofs.bodies.add({16, 16, 9}, [](int i, int j, int k) { return Vec3(100 + 10 * i, 10 * j, 10 * k); });
    Simulation::Parts parts;
    parts.model = std::make_unique<Model>(model_of(roofs, {.stiffness = 2, .search = 6, .friction = 0.3}));
    Vectors loads(parts.model->tissue.node_count(), Vec3::Zero());
    for (std::size_t n = roofs.upper; n < roofs.upper + 12; ++n)
      if (parts.model->tissue.rest_positions[n].z() > Roofs::height) loads[n] = {0, 0.1, -0.5};
    parts.model->laws.push_back(std::make_unique<NodalForces>(loads));
    parts.controls.fixed_step_s = 4;
    parts.controls.end_s = 90;
    parts.controls.stop_at_equilibrium = false;
    return Simulation(std::move(parts));
  };
  const auto press = [](const Simulation& simulation) {
    const std::vector<ContactPair> edges =
        edges_of(simulation.state().internals.at(simulation.state().internals.size() - 2));
    return std::ranges::any_of(edges, [](const ContactPair& pair) { return pair.first_gap < pair.distance; });
  };
  Simulation whole = fresh();
  while (!press(whole)) ASSERT_TRUE(whole.step()) << whole.failure();
  Simulation fork = whole, resumed = fresh(), from_bytes = fresh();
  resumed.go_on_from(whole.memory());
  go_on_by_bytes(from_bytes, whole.memory());
  int steps = 0, pressed = 0;
  while (whole.step()) {
    ++steps, pressed += press(whole);
    ASSERT_TRUE(resumed.step());
    ASSERT_TRUE(from_bytes.step());
    const ThreadCount three(3);
    ASSERT_TRUE(fork.step());
    for (const Simulation* other : {&resumed, &from_bytes, &fork}) expect_same(whole.state(), other->state());
  }
  std::printf("edges press in %d of %d steps\n", pressed, steps);
  EXPECT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  EXPECT_GE(pressed, 10);
}

// A run of which nobody takes memories goes on from resumable steps to the same bits, too: they come by themselves.
TEST(Resume, FromResumableStepsOfARunLeftAlone) {
  for (const std::string solver : {"direct", "cholesky", "multigrid"}) {
    SCOPED_TRACE(solver);
    const Scenario scenario = load_scenario(
        find_scenario("drosophila"), {"time.end_s=4", "time.max_step_s=0.1", "time.linear_solver=\"" + solver + "\""});
    Simulation alone(scenario), whole(scenario);
    std::optional<Simulation> resumed;
    std::vector<int> resumable;
    while (whole.step()) {
      if (!whole.is_resumable()) continue;
      resumable.push_back(whole.steps());
      if (resumed || whole.steps() < 5) continue;
      resumed.emplace(scenario);
      resumed->go_on_from(whole.memory());
    }
    alone.run();
    ASSERT_TRUE(resumed);
    resumed->run();
    expect_same(whole.state(), alone.state());
    expect_same(whole.state(), resumed->state());
    for (std::size_t i = 1; i < resumable.size(); ++i) EXPECT_LE(resumable[i] - resumable[i - 1], 20);
    EXPECT_EQ(resumable.back(), whole.steps());
  }
}

// Divisions lie behind some memories and before others; growth is under way in many.
TEST(Resume, AcrossDivisions) {
  expect_resumable("drosophila-division-twice",
                   {"division.floor.at_min=0.2", "division.floor.growth_min=0.3", "division.borders.at_min=0.7",
                    "division.borders.growth_min=0.3", "time.end_min=1.5", bdf2},
                   11);
}

// Cells divide again while they grow; faces, springs, strengths, holds and flowing cortices are inherited. From every
// step, by the bytes of a checkpoint.
TEST(Resume, AcrossDivisionsOfGrowingCells) {
  const Scenario scenario = load_scenario(pulled_block(R"(
[cortex.walls]
region = "all"
faces = "lateral"
tension_mN_per_m = 0.3
stiffness_mN_per_m = 0.5
relaxation_min = 0.1
[cortex.top]
region = "all"
faces = "apical"
tension_mN_per_m = 0.2
variation = { spread = 0.3 }
[hold.end]
region = "all"
x_um = [-1000, -29]
directions = ["x"]
[division.first]
region = "all"
at_s = 1
growth_s = 2.5
[division.second]
region = "all"
at_s = 2
growth_s = 1
max_generation = 2
)"));
  Simulation whole(scenario);
  std::vector<RunMemory> memories;
  while (whole.step()) memories.push_back(whole.memory());
  ASSERT_EQ(whole.status(), RunStatus::end_time) << whole.failure();
  ASSERT_GE(memories.size(), 8U);
  EXPECT_EQ(whole.model().tissue.cells.size(), 24U);
  for (std::size_t k = 0; k < memories.size(); ++k) {
    SCOPED_TRACE(k);
    Simulation rest(scenario);
    go_on_by_bytes(rest, memories[k]);
    while (rest.step()) (void)rest.memory();
    expect_same(rest.state(), whole.state());
    EXPECT_EQ(rest.steps(), whole.steps());
    EXPECT_EQ(rest.measures().monitors, whole.measures().monitors);
    EXPECT_EQ(as_numbers(*rest.memory().changes), as_numbers(*whole.memory().changes));
  }
}

}  // namespace
