// Warnings during a run (bending, energy, pace); runs that fail, and the remedies that their messages name: each is
// tried.
#include <regex>

#include "core/errors.hpp"
#include "scenario/advice.hpp"
#include "scenario/load.hpp"
#include "simulation/run_warnings.hpp"
#include "simulation/simulation.hpp"
#include "support/scenarios.hpp"

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
  for (const auto& [shape, named, remedy] :
       {std::tuple("shape = \"sheet\"\ncell_count = 48", "compare with embryo.layers = 2", "embryo.layers=2"),
        {"shape = \"block\"\ncells = [4, 12, 1]", "compare with embryo.elements_per_cell = [1, 1, 2]",
         "embryo.elements_per_cell=[1,1,2]"}}) {
    const std::string warning = warning_of(shape, {});
    EXPECT_SAYS(warning, named);
    EXPECT_EQ(warning_of(shape, {remedy}), "");
    EXPECT_EQ(warning_of(shape, {"contraction.apical.stiffness_nN_per_um=0.2"}), "");
  }
}

double depth_of(const Simulation& simulation) { return simulation.measures()["furrow_depth_um"].value(); }

// The depth of a small sheet with free ends errs four to five times as much as its bending.
TEST(BendingWarning, SaysNoLessOfTheDepthThanFourLayersShow) {
  const std::string sheet = "format = 1\n" + block_table(40, 60, 15, "4, 6, 1") + R"([region.stripe]
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
const std::string stripe = block_table(16, 40, 12, "2, 5, 1") + R"([region.stripe]
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
  Simulation simulation(scenario_of(stripe, overrides));
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
    for (const std::string& key : named) EXPECT_SAYS(text, key);
    const Texts remedy = remedy_in(text);
    EXPECT_EQ(remedy.size(), named.size()) << text;
    Texts changed = given;
    changed.insert(changed.end(), remedy.begin(), remedy.end());
    EXPECT_EQ(energy_warning_of(changed), "") << text;
  }
}

TEST(EnergyWarning, IsSilentWhereNothingIsWrong) {
  EXPECT_EQ(energy_warning_of({"time.integrator=bdf2", slowly}), "");
  // The first steps weigh most in a run of few.
  EXPECT_EQ(energy_warning_of({"time.integrator=bdf2", "time.end_s=0.3"}), "");
  // Projections do work that no law counts, at any step.
  EXPECT_EQ(energy_warning_of({"time.integrator=backward-euler", "volume.method=projection", "time.step_s=2"}), "");
}

// Two layers of kites between fixed ends, whose lateral edges pull with a hundred times what the cells can carry.
const std::string crushing = sheet_table(15.51, 9.913, 18.09, 12) + R"(seed = 664
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
)";
Simulation crushed() { return Simulation(load_scenario({"crushed", "crushed.toml", crushing})); }

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
  resumed.go_on_from(*halfway);
  resumed.run();
  EXPECT_EQ(resumed.failure(), run.failure());
  EXPECT_EQ(resumed.state().positions, run.state().positions);
}

// Steps about changes of the tissue are short and hard, but the tissue changes: the pace counts from the last one.
TEST(Pace, CountsFromTheLastChangeOfTheTissue) {
  Simulation run(scenario_of("format = 1\n" + exchanging_sheet + "[division.all]\nregion = \"all\"\nat_s = 4\n"));
  int changed = 0, unchanged = 0;
  for (int events = 0; run.step();) {
    const RunMemory memory = run.memory();
    const int now = memory.state.exchanges.count + memory.divisions;
    const bool has_changed = now != std::exchange(events, now);
    ++(has_changed ? changed : unchanged);
    EXPECT_EQ(memory.pace.steps == 0, has_changed);
    EXPECT_EQ(memory.pace.iterations == 0, has_changed);
    EXPECT_EQ(memory.pace.since_s == memory.state.time_s, has_changed);
  }
  EXPECT_EQ(run.status(), RunStatus::end_time) << run.failure();
  EXPECT_GT(run.divisions(), 0);
  EXPECT_GT(changed, 2);
  EXPECT_GT(unchanged, 2);
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

Simulation ran(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Simulation simulation(load_scenario({"failing", "failing.toml", text}, overrides));
  simulation.run();
  return simulation;
}

// A thin held_sheet of polygons whose stripe contracts.
const std::string held_sheet = sheet_table(60, 60, 10, 100) + R"(rim = "held"
[region.stripe]
y_um = [-10, 10]
[time]
end_s = 2
)";
const std::string without_barrier = "[elasticity]\ncorner_barrier_Pa = 0\n";
const std::string stripe_springs = "[contraction.apical]\nregion = \"stripe\"\nstiffness_nN_per_um = 12\n";

// Cells of a grid; follow with the end of the run.
const std::string grid = block_table(30, 20, 15, "6, 4, 1") + R"([time]
)";
const std::string block = grid + "end_s = 20\n";
const std::string push = "[contraction.push]\nregion = \"all\"\npreload_nN = ";

// A row of cells of which one divides.
const std::string division = block_table(60, 20, 40, "3, 1, 1") + R"([region.middle]
ids = [1]
[region.first]
ids = [0]
[hold.firm]
region = "all"
[division.cut]
region = "middle"
at_s = 5
growth_s = 20
[time]
end_s = 30
)";

struct FailingCase {
  std::string name, text;
  std::vector<std::string> first_keys;  // of the remedies, in order
};

const std::vector<FailingCase> failing = {
    {"springs of a sheet",
     held_sheet + without_barrier + stripe_springs,
     {"elasticity.corner_barrier_Pa", "contraction.apical.program", "contraction.apical.stiffness_nN_per_um"}},
    {"tension of a sheet",
     held_sheet + without_barrier + "[contraction.apical]\nregion = \"stripe\"\ntension_mN_per_m = 12\n",
     {"elasticity.corner_barrier_Pa", "contraction.apical.program", "contraction.apical.tension_mN_per_m"}},
    {"cortex of a sheet",
     held_sheet + without_barrier + "[cortex.apical]\nregion = \"stripe\"\ntension_mN_per_m = 12\n",
     {"elasticity.corner_barrier_Pa", "cortex.apical.program", "cortex.apical.tension_mN_per_m"}},
    {"gradual springs",
     held_sheet + without_barrier + stripe_springs + "program = { time_s = [0, 1], activity = [0, 1] }\n",
     {"elasticity.corner_barrier_Pa", "contraction.apical.stiffness_nN_per_um"}},
    {"springs that push",
     grid + "end_s = 0.2\n" + push + "-200\n",
     {"elasticity.corner_barrier_Pa", "contraction.push.program", "contraction.push.preload_nN"}},
    {"springs that push very hard", block + push + "-1e6\n", {"contraction.push.preload_nN"}},
    {"forces beyond all numbers",
     block + "[contraction.pull]\nregion = \"all\"\nstiffness_nN_per_um = 1e300\n",
     {"contraction.pull.stiffness_nN_per_um"}},
    {"pressure",
     grid + "end_s = 3\n" + "[pressure.p]\nregion = \"all\"\npressure_Pa = 30000\n",
     {"elasticity.corner_barrier_Pa", "pressure.p.program", "pressure.p.pressure_Pa"}},
    {"springs that crush a sheet", crushing, {"contraction.load.stiffness_nN_per_um"}},
    {"conjugate gradients", block + push + "1\n" + "[volume]\nmethod = \"none\"\n", {"time.cg_max_iterations"}},
};

std::vector<std::string> overrides_of(const FailingCase& one) {
  if (one.name != "conjugate gradients") return {};
  return {"time.scheme=linearly-implicit", "time.cg_max_iterations=1"};
}

TEST(Remedies, EachCuresOrDelaysAFailure) {
  int tried = 0;
  for (const FailingCase& one : failing) {
    SCOPED_TRACE(one.name);
    const Simulation failed = ran(one.text, overrides_of(one));
    ASSERT_EQ(failed.status(), RunStatus::failed);
    const auto remedies = named_remedies(failed.failure());
    ASSERT_EQ(remedies.size(), one.first_keys.size()) << failed.failure();
    for (std::size_t r = 0; r < remedies.size(); ++r) {
      EXPECT_TRUE(remedies[r].front().starts_with(one.first_keys[r] + " = ")) << failed.failure();
      std::vector<std::string> overrides = overrides_of(one);
      overrides.insert(overrides.end(), remedies[r].begin(), remedies[r].end());
      const Simulation cured = ran(one.text, overrides);
      std::printf("%s: fails at %.3g s; with %s %s at %.3g s\n", one.name.c_str(), failed.time_s(),
                  remedies[r].front().c_str(), word(cured.status()), cured.time_s());
      EXPECT_TRUE(cured.status() != RunStatus::failed || cured.time_s() > 1.2 * failed.time_s() + 1e-9)
          << remedies[r].front();
      ++tried;
    }
  }
  EXPECT_EQ(tried, 21);
}

// A barrier is what helps most, so it comes first, and where cells are polygons it is there already.
TEST(Remedies, PolygonsNeedNoneByDefault) {
  const Simulation simulation = ran(held_sheet + stripe_springs);
  EXPECT_NE(simulation.status(), RunStatus::failed) << simulation.failure();
}

// The volume inside the apical surface cannot be kept by a fold in a filled membrane.
TEST(Remedies, AFoldNeedsRoom) {
  const Scenario filled = load_scenario(
      {"pill", "pill.toml",
       "[embryo]\ncells = [4, 4, 2]\n[volume]\nmethod = \"projection\"\nprojection_surface = \"embryo\"\n"});
  const auto remedies = remedies_of(filled, {StepReport::Status::not_projected});
  ASSERT_EQ(remedies.size(), 2U);
  EXPECT_EQ(remedies[0].settings[0].key, "volume.projection_surface");
  EXPECT_EQ(remedies[1].settings[0].key, "vitelline.gap_um");
}

TEST(Remedies, ACellHeldAtAllItsCornersCannotGrow) {
  const Simulation failed = ran(division);
  ASSERT_EQ(failed.status(), RunStatus::failed);
  EXPECT_SAYS(failed.failure(), "fix fewer nodes, or exclude it from division and growth");
  for (const char* override : {"hold.firm.region=first", "hold.firm.directions=[\"x\"]"})
    EXPECT_NE(ran(division, {override}).status(), RunStatus::failed) << override;
}

// The run command warns of an equilibrium after the first step, and names three remedies.
TEST(Remedies, ATissueThatHardlyMoves) {
  const std::string weak = block + "[contraction.c]\nregion = \"all\"\nstiffness_nN_per_um = 1e-4\n";
  EXPECT_EQ(ran(weak).steps(), 1);
  for (const char* override : {"stop.equilibrium_speed_um_per_min=1e-4", "contraction.c.stiffness_nN_per_um=1",
                               "dynamics.surface_drag_Pa_s_per_um=0.1"})
    EXPECT_GT(ran(weak, {override}).steps(), 1) << override;
}

// A message never names a key that the scenario lacks: each remedy loads, whatever the shape and the failure.
TEST(Remedies, NameKeysOfTheScenario) {
  using Status = StepReport::Status;
  int loaded = 0;
  for (const std::string shape : {"pill", "sphere", "slice", "block", "egg", "sheet"})
    for (const std::string more :
         {"",
          "[time]\nscheme = \"linearly-implicit\"\n[volume]\nmethod = \"projection\"\nprojection_surface = "
          "\"tissue\"\n",
          "[contraction.c]\nregion = \"all\"\nstiffness_nN_per_um = 1\npreload_nN = -1\ntension_mN_per_m = 1\n",
          "[cortex.c]\nregion = \"all\"\ntension_mN_per_m = 1\n[pressure.p]\nregion = \"all\"\npressure_Pa = "
          "10\n[elasticity]\ncorner_barrier_Pa = 0\n"}) {
      const ScenarioSource source{"any", "any.toml", "[embryo]\nshape = \"" + shape + "\"\n" + more};
      const Scenario scenario = load_scenario(source);
      for (const Status status : {Status::inverted_element, Status::no_convergence, Status::no_linear_convergence,
                                  Status::singular_system, Status::not_projected, Status::not_finite})
        for (const Remedy& remedy : remedies_of(scenario, {status, 1})) {
          std::vector<std::string> overrides;
          for (const auto& [key, value] : remedy.settings) overrides.push_back(key + "=" + value);
          // What cannot happen with a scheme is not asked for.
          if (status == Status::no_linear_convergence && scenario.time.scheme == "newton") continue;
          if (status == Status::not_projected && scenario.volume.method != "projection") continue;
          EXPECT_NO_THROW((void)load_scenario(source, overrides)) << shape << more << overrides.front();
          ++loaded;
        }
    }
  EXPECT_EQ(loaded, 192);
}

}  // namespace
