#include "scenario/syntax.hpp"

#include <gtest/gtest.h>

#include <string>

namespace plica {
namespace {

TEST(Nesting, AKeyWithTooManyPartsIsFoundWhereverItStands) {
  std::string deep = "a";
  for (int part = 1; part <= most_key_parts; ++part) deep += part % 3 == 0 ? " . \"b.c\"" : ".'d'";
  for (const std::string& text : {deep + " = 1", "[" + deep + "]", "[[" + deep + "]]", "x = {y = 1, " + deep + " = 1}",
                                  "x = [{" + deep + " = 1}]", "# \"\nx = '''''\\'''''\n\"\\\"\" = 1\n" + deep + " = 1"})
    EXPECT_EQ(line_of_too_deep_key("\n" + text), text.starts_with('#') ? 5 : 2) << text;
}

TEST(Nesting, DotsInTextsNumbersAndCommentsAreNone) {
  const std::string dots(100, '.');
  for (const std::string& text : {"x = \"" + dots + "\"", "x = '" + dots + "'", "x = \"\"\"\n\"" + dots + "\"\"\"\"\"",
                                  "# " + dots, "x = \"\\\"" + dots + "\"",
                                  std::string("x = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 1.0, 2.0, 3.0, 4.0, "
                                              "5.0, 6.0, 7.0, 8.0, 9.0]"),
                                  std::string("a.b.c.d = 1\ne.f.g.h = 2\n[a.b.c.d]\n[a.b.c.e]\n[i.b.c.e]\n")})
    EXPECT_EQ(line_of_too_deep_key(text), 0) << text;
}

}  // namespace
}  // namespace plica
