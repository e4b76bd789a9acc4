// Runs that fail, and the remedies that their messages name: each is tried.
#include "scenario/remedies.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "scenario/load.hpp"
#include "simulation/simulation.hpp"
#include "support/named_remedies.hpp"

namespace plica {
namespace {

using support::named_remedies;

Simulation ran(const std::string& text, const std::vector<std::string>& overrides = {}) {
  Simulation simulation(load_scenario({"failing", "failing.toml", text}, overrides));
  simulation.run();
  return simulation;
}

// A thin sheet of polygons whose stripe contracts.
const std::string sheet = R"([embryo]
shape = "sheet"
length_um = 60
width_um = 60
cell_count = 100
cell_height_um = 10
rim = "held"
[region.stripe]
y_um = [-10, 10]
[time]
end_s = 2
)";
const std::string without_barrier = "[elasticity]\ncorner_barrier_Pa = 0\n";
const std::string springs = "[contraction.apical]\nregion = \"stripe\"\nstiffness_nN_per_um = 12\n";

// Cells of a grid; follow with the end of the run.
const std::string grid = R"([embryo]
shape = "block"
length_um = 30
width_um = 20
cell_height_um = 15
cells = [6, 4, 1]
[time]
)";
const std::string block = grid + "end_s = 20\n";
const std::string push = "[contraction.push]\nregion = \"all\"\npreload_nN = ";

// A row of cells of which one divides.
const std::string division = R"([embryo]
shape = "block"
length_um = 60
width_um = 20
cell_height_um = 40
cells = [3, 1, 1]
[region.middle]
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
     sheet + without_barrier + springs,
     {"elasticity.corner_barrier_Pa", "contraction.apical.program", "contraction.apical.stiffness_nN_per_um"}},
    {"tension of a sheet",
     sheet + without_barrier + "[contraction.apical]\nregion = \"stripe\"\ntension_mN_per_m = 12\n",
     {"elasticity.corner_barrier_Pa", "contraction.apical.program", "contraction.apical.tension_mN_per_m"}},
    {"cortex of a sheet",
     sheet + without_barrier + "[cortex.apical]\nregion = \"stripe\"\ntension_mN_per_m = 12\n",
     {"elasticity.corner_barrier_Pa", "cortex.apical.program", "cortex.apical.tension_mN_per_m"}},
    {"gradual springs",
     sheet + without_barrier + springs + "program = { time_s = [0, 1], activity = [0, 1] }\n",
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
    {"springs that crush a sheet",
     "[embryo]\nshape = \"sheet\"\nlength_um = 15.51\nwidth_um = 9.913\ncell_count = 12\ncell_height_um = 18.09\n"
     "seed = 664\nelements = \"kites\"\nlayers = 2\nrim = \"held\"\n[elasticity]\nyoung_modulus_Pa = 130\n"
     "[time]\nend_s = 180\n[contraction.load]\nregion = \"all\"\nedges = \"lateral\"\n"
     "stiffness_nN_per_um = 20\nprogram = { time_s = [0, 60], activity = [0, 1] }\n",
     {"contraction.load.stiffness_nN_per_um"}},
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
  const Simulation simulation = ran(sheet + springs);
  EXPECT_NE(simulation.status(), RunStatus::failed) << simulation.failure();
}

// The volume inside the apical surface cannot be kept by a fold in a filled membrane.
TEST(Remedies, AFoldNeedsRoom) {
  const Scenario filled = load_scenario({"pill", "pill.toml",
                                         "[embryo]\ncells = [4, 4, 2]\n[volume]\nmethod = \"projection\"\n"
                                         "projection_surface = \"embryo\"\n"});
  const auto remedies = remedies_of(filled, {StepReport::Status::not_projected});
  ASSERT_EQ(remedies.size(), 2U);
  EXPECT_EQ(remedies[0].settings[0].key, "volume.projection_surface");
  EXPECT_EQ(remedies[1].settings[0].key, "vitelline.gap_um");
}

TEST(Remedies, ACellHeldAtAllItsCornersCannotGrow) {
  const Simulation failed = ran(division);
  ASSERT_EQ(failed.status(), RunStatus::failed);
  EXPECT_NE(failed.failure().find("fix fewer nodes, or exclude it from division and growth"), std::string::npos)
      << failed.failure();
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
          "[time]\nscheme = \"linearly-implicit\"\n[volume]\nmethod = \"projection\"\n"
          "projection_surface = \"tissue\"\n",
          "[contraction.c]\nregion = \"all\"\nstiffness_nN_per_um = 1\npreload_nN = -1\ntension_mN_per_m = 1\n",
          "[cortex.c]\nregion = \"all\"\ntension_mN_per_m = 1\n[pressure.p]\nregion = \"all\"\npressure_Pa = 10\n"
          "[elasticity]\ncorner_barrier_Pa = 0\n"}) {
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
}  // namespace plica
