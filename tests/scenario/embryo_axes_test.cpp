// Key `embryo.axes`: names of the ends of x, y and z, their letters, and lists that are refused.
#include "scenario/embryo_axes.hpp"

#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "scenario/load.hpp"

namespace plica {
namespace {

EmbryoAxes axes_in(const std::string& keys) {
  return axes_of(load_scenario({"test", "test.toml", "[embryo]\n" + keys}).embryo);
}

TEST(EmbryoAxes, AreAnatomicalForEmbryosAndPlainForOtherTissues) {
  EXPECT_EQ(axes_in(""), anatomical_axes());
  EXPECT_EQ(axes_in("shape = \"egg\""), anatomical_axes());
  EXPECT_EQ(axes_in("shape = \"sheet\""), plain_axes());
  EXPECT_EQ(axes_in("shape = \"block\""), plain_axes());
  EXPECT_EQ(plain_axes()[0], (std::array<std::string, 2>{"\u2212x", "+x"}));
  EXPECT_TRUE(have_furrow(anatomical_axes()));
  EXPECT_FALSE(have_furrow(plain_axes()));
}

TEST(EmbryoAxes, AreThoseOfTheScenario) {
  const EmbryoAxes axes = axes_in("shape = \"sheet\"\naxes = [\"proximal-distal\", \"anterior-posterior\", \"depth\"]");
  EXPECT_EQ(axes, (EmbryoAxes{{{"proximal", "distal"}, {"anterior", "posterior"}, {"\u2212depth", "+depth"}}}));
  EXPECT_TRUE(have_furrow(axes_in("shape = \"sheet\"\naxes = [\"x\", \"y\", \"ventral-dorsal\"]")));
}

TEST(EmbryoAxes, LettersAreTheShortestThatDiffer) {
  EXPECT_EQ(letters_of(anatomical_axes()), (EmbryoAxes{{{"A", "P"}, {"L", "R"}, {"V", "D"}}}));
  EXPECT_EQ(letters_of(plain_axes()), plain_axes());
  EXPECT_EQ(letters_of({{{"proximal", "distal"}, {"anterior", "posterior"}, {"basal", "api"}}}),
            (EmbryoAxes{{{"Pr", "D"}, {"An", "Po"}, {"B", "Ap"}}}));
  EXPECT_EQ(letters_of({{{"in", "inner"}, {"\u00fcber", "unter"}, {"a", "b"}}}),
            (EmbryoAxes{{{"In", "Inn"}, {"\u00fc", "U"}, {"A", "B"}}}));
}

TEST(EmbryoAxes, OtherListsAreRefused) {
  const std::string remedy = "; write, for example, [\"proximal-distal\", \"anterior-posterior\", \"z\"]";
  const std::vector<std::pair<std::string, std::string>> cases = {
      {R"(["x", "y"])", "has 2 names, not three"},
      {R"(["x"])", "has 1 name, not three"},
      {R"(["x", "y", "-z"])", R"("-z" is neither "low-high" nor one word)"},
      {R"(["a-b", "c-", "z"])", R"("c-" is neither "low-high" nor one word)"},
      {R"(["a-b", "c-d-e", "z"])", R"("c-d-e" is neither "low-high" nor one word)"},
      {R"(["a-b", "b-c", "z"])", R"("b" names two ends)"},
      {R"(["a-a", "y", "z"])", R"("a" names two ends)"}};
  for (const auto& [list, problem] : cases) {
    try {
      (void)axes_in("axes = " + list);
      ADD_FAILURE() << list;
    } catch (const ScenarioError& error) {
      ASSERT_EQ(error.diagnostics().size(), 1U);
      EXPECT_EQ(error.diagnostics()[0].text(), "test.toml:2: embryo.axes: " + problem + remedy);
    }
  }
}

}  // namespace
}  // namespace plica
