// Warnings, notes and errors of a tissue, and the remedies that they name: each is tried.
#include <gtest/gtest.h>

#include <algorithm>

#include "core/errors.hpp"
#include "scenario/advice.hpp"
#include "scenario/load.hpp"
#include "support/named_remedies.hpp"

namespace plica {
namespace {

using Overrides = std::vector<std::string>;

const std::string row =
    "[embryo]\nshape = \"block\"\nlength_um = 60\nwidth_um = 20\ncells = [3, 1, 1]\n[region.one]\nids = [1]\n"
    "[region.two]\nids = [2]\n[time]\nend_s = 60\n";
const std::string pull = "[contraction.c]\nregion = \"one\"\nstiffness_nN_per_um = 1\n";
const std::string sheet = "[embryo]\nshape = \"sheet\"\nlength_um = 30\nwidth_um = 30\ncell_count = 20\n";
const std::string division = "[division.cut]\nregion = \"all\"\nat_s = 5\n";

struct AdviceCase {
  std::string text;
  std::string phrase;
  std::vector<Overrides> remedies = {};  // empty: those that the message spells out
};

const std::vector<AdviceCase> cases = {
    {row,
     "no force acts",
     {{"contraction.c.region=all", "contraction.c.tension_mN_per_m=1"},
      {"cortex.c.region=all", "cortex.c.tension_mN_per_m=1"},
      {"pressure.p.region=all", "pressure.p.pressure_Pa=1"},
      {"division.d.region=one", "division.d.at_s=5"}}},
    {row + "[contraction.c]\nregion = \"one\"\n",
     "contraction.c: has no effect",
     {{"contraction.c.stiffness_nN_per_um=1"}, {"contraction.c.preload_nN=1"}, {"contraction.c.tension_mN_per_m=1"}}},
    {row + "[division.cut]\nregion = \"one\"\nat_s = 90\n",
     "division.cut: the division occurs after the end",
     {{"division.cut.at_s=5"}, {"time.end_s=100"}}},
    {row + "[monitor.m]\nquantity = \"volume\"\nat_s = 90\n",
     "monitor.m: at_s is after the end",
     {{"monitor.m.at_s=5"}, {"time.end_s=100"}}},
    {row + pull + "[ablation.a]\nregion = \"one\"\nat_s = 90\n",
     "ablation.a: the ablation starts after the end",
     {{"ablation.a.at_s=5"}, {"time.end_s=100"}}},
    {row + pull + "[ablation.a]\nregion = \"two\"\nfaces = [\"basal\"]\nat_s = 5\n",
     "ablation.a: has no effect",
     {{"ablation.a.faces=[\"apical\"]", "ablation.a.region=one"}}},
    {row + pull + "program = { time_s = [0, 1], activity = [0, 0] }\n",
     "program is 0 at all times",
     {{"contraction.c.program.activity=[0, 1]"}}},
    {row + pull + "program = { time_s = [0, 90], activity = [0, 1] }\n",
     "program extends beyond",
     {{"contraction.c.program.time_s=[0, 30]"}, {"time.end_s=100"}}},
    {row + pull +
         "[cortex.x]\nregion = \"one\"\ntension_mN_per_m = 1\nprogram = { time_s = [0, 90], activity = [0, 1] }\n",
     "program extends beyond",
     {{"cortex.x.program.time_s=[0, 30]"}, {"time.end_s=100"}}},
    {row + pull, "time step is longer than the run", {{"time.step_s=30"}, {"time.end_s=400"}}},
    {row + pull + "profile = { shape = \"plateau\", full_cells = 2, fade_cells = 1, middle = 0 }\n",
     "profile is 0 in every cell",
     {{"contraction.c.profile.middle=1"}}},
    {row + pull + "[volume]\nmethod = \"projection\"\n",
     "time.integrator is \"backward-euler\", since \"bdf2\" does not support volume.method",
     {{"volume.method=coupled"}, {"time.integrator=backward-euler"}}},
    {row + pull + "[volume]\nmethod = \"projection\"\n", "the equilibrium of a projection", {{"time.step_s=5"}}},
    {row + pull + "[contraction.d]\nregion = \"two\"\nstiffness_nN_per_um = 1\n",
     "the fold is measured on the largest",
     {{"furrow.region=one"}, {"furrow.region=two"}}},
    {row + pull + "[furrow]\nregion = \"two\"\n", "apical surfaces contract in one", {{"furrow.region=one"}}},
    {"[embryo]\nshape = \"block\"\ncells = [3, 1, 1]\nelements_per_cell = [1, 1, 2]\n[elasticity]\nmodel = "
     "\"shape-memory\"\n",
     "shape memory acts on whole cells"},
    {sheet + "[elasticity]\nmodel = \"shape-memory\"\n", "shape memory acts on whole cells"},
    {row + "[elasticity]\nmodel = \"neo-hookean\"\n", "neo-hookean cells of one element"},
    {row + "[elasticity]\nmodel = \"neo-hookean\"\nrelaxation_s = 60\n", "neo-hookean cells of one element"},
    {row + "[elasticity]\nmodel = \"neo-hookean\"\n" + division, "neo-hookean cells of one element"},
    {sheet + "[contraction.c]\nregion = \"all\"\nstiffness_nN_per_um = 1\n[cortex.x]\nregion = \"all\"\n"
             "tension_mN_per_m = 1\n",
     "forces act in full from t = 0"},
};

std::vector<std::string> advice_with(const AdviceCase& one, const Overrides& overrides) {
  Overrides all;
  if (one.phrase.starts_with("time step is longer")) all.emplace_back("time.step_s=300");
  all.insert(all.end(), overrides.begin(), overrides.end());
  const Scenario scenario = load_scenario({"test", "test.toml", one.text}, all);
  std::vector<std::string> lines = advice(scenario, *make_model(scenario));
  std::erase_if(lines, [&](const std::string& line) { return line.find(one.phrase) == std::string::npos; });
  return lines;
}

TEST(AdviceRemedies, EachEndsItsMessage) {
  int tried = 0;
  for (const AdviceCase& one : cases) {
    SCOPED_TRACE(one.text);
    const std::vector<std::string> lines = advice_with(one, {});
    ASSERT_EQ(lines.size(), 1U);
    const auto remedies = one.remedies.empty() ? support::named_remedies(lines[0]) : one.remedies;
    EXPECT_FALSE(remedies.empty()) << lines[0];
    for (const Overrides& remedy : remedies) {
      EXPECT_EQ(advice_with(one, remedy), std::vector<std::string>()) << remedy.front();
      ++tried;
    }
  }
  EXPECT_EQ(tried, 35);
}

// Each shape has its own keys.
TEST(AdviceRemedies, CellsThatCannotDivideNameKeysOfTheirShape) {
  const std::string kites = "set embryo.elements to \"diagonals\" and embryo.layers to 1";
  for (const auto& [text, remedy, overrides] :
       {std::tuple(sheet + "elements = \"kites\"\n", kites, Overrides{"embryo.elements=diagonals"}),
        {sheet + "layers = 2\n", kites, {"embryo.layers=1"}},
        {"[embryo]\nshape = \"block\"\ncells = [3, 1, 1]\nelements_per_cell = [1, 1, 2]\n",
         "set embryo.elements_per_cell to [1, 1, 1]",
         {"embryo.elements_per_cell=[1, 1, 1]"}},
        {"[embryo]\nshape = \"block\"\ncells = [3, 1, 2]\n", "use one layer of cells", {"embryo.cells=[3, 1, 1]"}}}) {
    const ScenarioSource source{"test", "test.toml", text + division};
    try {
      (void)make_model(load_scenario(source));
      ADD_FAILURE() << text;
    } catch (const ScenarioError& error) {
      ASSERT_EQ(error.diagnostics().size(), 1U);
      EXPECT_EQ(error.diagnostics()[0].remedy, remedy);
    }
    EXPECT_NO_THROW((void)make_model(load_scenario(source, overrides))) << overrides.front();
  }
}

}  // namespace
}  // namespace plica
