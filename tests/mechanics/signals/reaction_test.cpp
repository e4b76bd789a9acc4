#include "mechanics/signals/reaction.hpp"

#include <cmath>

#include "support/testing.hpp"

namespace {

const std::vector<std::string> variables = {"u", "v"};

std::string error_in(const std::string& text) {
  try {
    const Reaction reaction(text, variables, {{"k", 2}});
    return "";
  } catch (const ReactionError& error) {
    return error.what() + (error.unknown.empty() ? "" : " (" + error.unknown + ")");
  }
}

TEST(Reaction, IsAnExpressionOfVariablesAndConstants) {
  Reaction reaction("k * u^2 - max(u, v) + (u > 1 ? 1 : 0)", variables, {{"k", 2}});
  EXPECT_EQ(reaction.at(std::vector<double>{0.5, 3}), 0.5 - 3);
  EXPECT_EQ(reaction.at(std::vector<double>{2, 3}), 8 - 3 + 1);
  EXPECT_TRUE(reaction.reads("v"));
  EXPECT_FALSE(Reaction("u", variables, {}).reads("v"));
  EXPECT_TRUE(std::isinf(Reaction("1 / u", variables, {}).at(std::vector<double>{0, 0})));
  EXPECT_TRUE(std::isnan(Reaction("sqrt(-1 - u)", variables, {}).at(std::vector<double>{0, 0})));
}

TEST(Reaction, SaysWhatIsWrong) {
  EXPECT_EQ(error_in("k * w"), "\"w\" is unknown (w)");
  EXPECT_TRUE(error_in("k * u +").starts_with("cannot be read: unexpected end of expression"));
  EXPECT_EQ(error_in("u = 3"), "assigns a value with \"=\"");
  EXPECT_EQ(error_in("u == 3"), "");
  EXPECT_EQ(error_in("u <= 3 && v != 2"), "");
  EXPECT_EQ(error_in("u, v"), "has 2 expressions instead of one");
  for (const char* broken : {"", " ", "\"u\"", "sin(", "sin()", "sin(u, v)", "u v", "2u", "(", "u ? 1", "\n", "µ", "@"})
    EXPECT_FALSE(error_in(broken).empty()) << broken;
}

TEST(Reaction, NamesAreIdentifiers) {
  for (const char* name : {"u", "_u1", "Delta"}) EXPECT_TRUE(is_reaction_name(name)) << name;
  for (const char* name : {"", "1u", "u-v", "ü", "u v"}) EXPECT_FALSE(is_reaction_name(name)) << name;
}

}  // namespace
