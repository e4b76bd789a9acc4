// Where the furrow of a scenario is measured.
#include "scenario/setup.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenario/load.hpp"

namespace plica {
namespace {

// Strip of seven cells with contractions in three regions, of one, three and two cells.
Scenario three_contractions(const std::string& more = "") {
  std::string text =
      "[embryo]\nshape = \"block\"\nlength_um = 140\nwidth_um = 20\ncell_height_um = 30\ncells = [7, 1, 1]\n"
      "[region.one]\nids = [0]\n[region.three]\nids = [2, 3, 4]\n[region.two]\nids = [5, 6]\n";
  for (const std::string region : {"one", "three", "two"})
    text += "[contraction." + region + "]\nregion = \"" + region + "\"\nstiffness_nN_per_um = 1\n";
  return load_scenario({"strip", "strip.toml", text + more});
}

TEST(FurrowRegion, IsTheLargestOnWhichContractionsAct) {
  const Scenario scenario = three_contractions();
  const Tissue tissue = make_tissue(scenario);
  EXPECT_EQ(contracting_regions(scenario, tissue), (std::vector<std::string>{"three", "two", "one"}));
  EXPECT_EQ(make_furrow_sites(scenario, tissue).contractile, tissue.regions.at("three"));
}

TEST(FurrowRegion, IsTheOneThatIsNamed) {
  const Scenario scenario = three_contractions("[furrow]\nregion = \"one\"\nvce_cell = 1\n");
  const Tissue tissue = make_tissue(scenario);
  EXPECT_EQ(make_furrow_sites(scenario, tissue).contractile, tissue.regions.at("one"));
}

TEST(FurrowRegion, IsNoneWithoutContraction) {
  Scenario scenario = three_contractions();
  scenario.contractions.clear();
  const Tissue tissue = make_tissue(scenario);
  const FurrowSites sites = make_furrow_sites(scenario, tissue);
  EXPECT_EQ(std::ranges::count(sites.contractile, true), 0);
  EXPECT_TRUE(sites.vml.empty());
}

}  // namespace
}  // namespace plica
