#include "core/errors.hpp"

#include <gtest/gtest.h>

namespace plica {
namespace {

TEST(Errors, ADiagnosticIsOneLineThatATerminalShows) {
  const Diagnostic diagnostic{"a\nb.toml", 3, "k\x1b[2J", "\"\xc2\x9b\x7f\" is wrong", "give \"µ\" or \"é\"\t"};
  EXPECT_EQ(diagnostic.text(), R"(a\nb.toml:3: k\u001B[2J: "\u009B\u007F" is wrong; give "µ" or "é"\u0009)");
  EXPECT_EQ(printable("plain, µm³ \xc2"), "plain, µm³ \\xC2");  // a byte that is no UTF-8
}

}  // namespace
}  // namespace plica
