#include "scenario/differences.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

TEST(ScenarioDifferences, AreKeysInDottedFormWithBothValues) {
  const auto keys = scenario_differences(
      "a = 1\n[embryo]\nshape = \"pill\"\ncells = [18, 9, 8]\n[time]\nend_s = 60.0\n[stop]\nat_equilibrium = true\n",
      "a = 1\n[embryo]\nshape = \"pill\"\ncells = [18, 9, 9]\n[time]\nend_s = 90.0\n[furrow]\nregion = \"belly\"\n");
  ASSERT_EQ(keys.size(), 4u);
  EXPECT_EQ(keys[0].key, "embryo.cells");
  EXPECT_EQ(keys[0].a, "[ 18, 9, 8 ]");
  EXPECT_EQ(keys[0].b, "[ 18, 9, 9 ]");
  EXPECT_EQ(keys[1].key, "furrow.region");
  EXPECT_EQ(keys[1].a, "");
  EXPECT_EQ(keys[2].key, "stop.at_equilibrium");
  EXPECT_EQ(keys[2].a, "true");
  EXPECT_EQ(keys[2].b, "");
  EXPECT_EQ(keys[3].key, "time.end_s");
}

TEST(ScenarioDifferences, AreNoneOfTheSameAndAllOfWhatIsNoToml) {
  EXPECT_TRUE(scenario_differences("a = 1", "a = 1").empty());
  ASSERT_EQ(scenario_differences("a = 1", "no toml").size(), 1u);
  EXPECT_EQ(scenario_differences("a = 1", "no toml")[0].a, "1");
}

}  // namespace
}  // namespace plica
