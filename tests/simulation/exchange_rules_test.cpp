// Runs in which cells exchange neighbours and leave: resumption, threads, signals, cells that have to leave.
#include "simulation/exchange_rules.hpp"

#include "core/threads.hpp"
#include "support/resumed.hpp"
#include "support/scenarios.hpp"
#include "tissue/faces.hpp"

namespace {

const std::string extension = "format = 1\n" + exchanging_sheet + "[output]\nframe_every_s = 0\n";

// From memories around events, by the bytes of a checkpoint, and on three threads.
void expect_resumable_events(const std::string& text, const std::vector<std::string>& overrides,
                             bool extrudes = false) {
  Simulation whole(scenario_of(text, overrides));
  std::vector<RunMemory> memories;
  struct Tracer final : SimulationListener {
    Tracer(const Simulation& of, std::vector<RunMemory>& into) : run(of), all(into) {}
    void step_accepted(const AcceptedStep&, const Observation&) override { all.push_back(run.memory()); }
    const Simulation& run;
    std::vector<RunMemory>& all;
  } tracer(whole, memories);
  whole.listen(tracer);
  EXPECT_EQ(whole.run(), RunStatus::end_time) << whole.failure();
  whole.stop_listening(tracer);
  const auto events_of = [](const State& state) { return state.exchanges.count + state.exchanges.extruded; };
  const int events = events_of(whole.state());
  EXPECT_GT(events, 2);
  EXPECT_EQ(whole.state().exchanges.extruded > 0, extrudes);
  const std::size_t cells = whole.model().tissue.cells.size();
  EXPECT_EQ(cells + static_cast<std::size_t>(whole.state().exchanges.extruded),
            36u + static_cast<std::size_t>(whole.divisions()));
  std::set<int> seen;
  int resumed = 0;
  for (std::size_t k = 1; k + 1 < memories.size(); ++k) {
    // The last memory before, and the first after each event.
    const State &last = memories[k - 1].state, &now = memories[k].state, &next = memories[k + 1].state;
    const bool is_near = extrudes ? now.exchanges.extruded != next.exchanges.extruded ||
                                        now.exchanges.extruded != last.exchanges.extruded
                                  : events_of(now) != events_of(next) || events_of(now) != events_of(last);
    if (!is_near) continue;
    if (++resumed > 4) break;
    const ThreadCount scope(resumed % 2 == 0 ? 3 : 1);
    Simulation fresh(scenario_of(text, overrides));
    go_on_by_bytes(fresh, memories[k]);
    std::vector<RunMemory> rest;
    Tracer of_fresh(fresh, rest);
    fresh.listen(of_fresh);
    fresh.run();
    fresh.stop_listening(of_fresh);
    expect_same(fresh.state(), whole.state());
    EXPECT_EQ(fresh.model().tissue.elements, whole.model().tissue.elements);
    EXPECT_EQ(fresh.measures().values, whole.measures().values);
  }
  EXPECT_GT(resumed, extrudes ? 0 : 2);
  std::cout << whole.state().exchanges.count << " exchanges, " << whole.state().exchanges.extruded
            << " cells have left, resumed from " << resumed << " moments\n";
}

// Daughters that shrink to small cells, lose their neighbours and leave.
const std::string leaving = extension + R"([region.middle]
x_um = [-8, 8]
y_um = [-8, 8]
[division.middle]
region = "middle"
at_s = 4
growth_s = 40
plane = "longest-axis"
daughter_volume_ratio = 0.25
[extrusion.middle]
region = "middle"
apical_area_below_um2 = 30
)";

// Amounts of a signal by the ids of cells, which may change only where cells leave.
struct SignalWatch final : SimulationListener {
  explicit SignalWatch(const Simulation& of) : run(of), amounts(now()) {}
  void step_accepted(const AcceptedStep&, const Observation&) override { compare(0); }
  void cells_divided(const TissueChange& change) override {
    CellSet stays(amounts.size(), false);
    for (const CellId cell : change.origin) stays[cell.index()] = true;
    double taken = 0;
    for (std::size_t c = 0; c < stays.size(); ++c) taken += stays[c] ? 0 : amounts[c];
    lost += taken;
    compare(taken);
  }
  void compare(double taken) {
    const double before = sum_of(amounts);
    amounts = now();
    EXPECT_NEAR(sum_of(amounts), before - taken, 1e-12 * before);
  }
  [[nodiscard]] std::vector<double> now() const {
    std::vector<double> values = run.model().volumes.volumes(run.state().positions);
    for (std::size_t c = 0; c < values.size(); ++c) values[c] *= run.state().signals[0][c];
    return values;
  }
  static double sum_of(const std::vector<double>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }
  const Simulation& run;
  std::vector<double> amounts;
  double lost = 0;
};

// Diffusion, divisions and exchanges conserve a signal; a cell that leaves takes its amount with it.
TEST(ExtrusionOfCells, TakeTheirSignalsWithThemAndNoMore) {
  Simulation run(scenario_of(leaving + "[signal.u]\ndiffusion_um2_per_min = 20\ninitial = 1\ninitial_spread = 0.5\n"));
  SignalWatch watch(run);
  run.listen(watch);
  EXPECT_EQ(run.run(), RunStatus::end_time) << run.failure();
  run.stop_listening(watch);
  EXPECT_GT(run.divisions(), 0);
  EXPECT_GT(run.state().exchanges.count, 0);
  EXPECT_GT(run.state().exchanges.extruded, 0);
  EXPECT_GT(watch.lost, 0);
}

// Truncated pyramids, of 9 um^2 at the apex and 36 at the base on average.
TEST(ExtrusionOfCells, AreSmallByEachBoundThatIsGiven) {
  const Simulation run(scenario_of(extension));
  State state = run.state();
  for (Vec3& x : state.positions)
    if (x.z() > 0) x.head<2>() *= 0.5;
  const auto leaving = [&](std::optional<double> apical, std::optional<double> basal) {
    return std::ranges::count(leaving_cells(run.model(), state, std::array{ExtrusionRule{"all", apical, basal}}), true);
  };
  EXPECT_EQ(leaving(20, {}), 36);
  EXPECT_EQ(leaving({}, 80), 36);
  EXPECT_EQ(leaving(20, 80), 36);
  EXPECT_EQ(leaving({}, 9), 0);
  EXPECT_EQ(leaving(20, 9), 0);
  EXPECT_EQ(leaving(2, 80), 0);
}

// Neighbours are as before, and walls that were judged only stay as they are.
TEST(ExchangeOfCells, IsUndoneWhereNoStepSucceeds) {
  Simulation run(scenario_of(extension));
  auto before = wall_neighbours(run.model().tissue);
  while (run.state().exchanges.count == 0) {
    before = wall_neighbours(run.model().tissue);
    ASSERT_TRUE(run.step());
  }
  Model model(run.model());
  State state(run.state());
  const auto without_order = [](std::vector<std::vector<CellId>> cells) {
    for (auto& of_cell : cells) std::ranges::sort(of_cell);
    return cells;
  };
  EXPECT_NE(without_order(wall_neighbours(model.tissue)), without_order(before));
  const auto outcome = undo_exchanges(model, state, {"all", 0.5, 0.85, 0});
  ASSERT_TRUE(outcome);
  EXPECT_EQ(outcome->turns.size(), static_cast<std::size_t>(run.state().exchanges.count));
  EXPECT_EQ(without_order(wall_neighbours(model.tissue)), without_order(before));
  EXPECT_EQ(state.exchanges.count, 0);
  EXPECT_NEAR(state.exchanges.energy, run.state().exchanges.energy + outcome->energy, 1e-12);
}

TEST(ExtrusionOfCells, EveryOneThatIsToldLeaves) {
  Simulation simulation(scenario_of(sheet_that_cells_leave("5")));
  EXPECT_EQ(simulation.run(), RunStatus::end_time) << simulation.failure();
  EXPECT_EQ(simulation.state().exchanges.extruded, 3);
  EXPECT_LE(simulation.measures()["max_volume_error"].value_or(1), 1e-9);
  for (const auto& element : simulation.model().tissue.elements)
    EXPECT_GT(hex_scaled_jacobian(gather(std::span<const Vec3>(simulation.state().positions), element)), 0);
}

TEST(ExchangeOfCells, GoesOnWithTheSameBits) {
  expect_resumable_events(extension, {"time.integrator=\"backward-euler\""});
  expect_resumable_events(extension, {"embryo.periodic=[\"x\",\"y\"]"});
}

TEST(ExtrusionOfCells, GoesOnWithTheSameBits) { expect_resumable_events(leaving, {}, true); }

}  // namespace
