// Rules of times: smallest difference, and points of a program.
#include <gtest/gtest.h>

#include "core/errors.hpp"
#include "scenario/load.hpp"

namespace plica {
namespace {

std::string error_of(const std::string& override_text) {
  try {
    load_scenario(find_scenario("drosophila"),
                  std::vector<std::string>{override_text, "contraction.apical.program.activity=[1, 1, 0]"});
  } catch (const ScenarioError& error) {
    return error.what();
  }
  return "";
}

TEST(TimeRules, AProgramMayJumpButNotTwiceAtOnce) {
  EXPECT_EQ(error_of("contraction.apical.program.time_s=[0, 10, 10]"), "");
  EXPECT_NE(error_of("contraction.apical.program.time_s=[10, 10, 10]").find("10 occurs three times"),
            std::string::npos);
  EXPECT_NE(error_of("contraction.apical.program.time_s=[0, 10, 10.0000001]").find("closer than 1e-06 s"),
            std::string::npos);
  EXPECT_NE(error_of("contraction.apical.program.time_s=[0, 10, 9]").find("do not increase"), std::string::npos);
}

TEST(TimeRules, ARunLastsLongerThanAnInstant) {
  const auto ends_at = [](const char* end) {
    return load_scenario(find_scenario("drosophila"), std::vector<std::string>{std::string("time.end_s=") + end});
  };
  EXPECT_THROW(ends_at("1e-7"), ScenarioError);
  EXPECT_NO_THROW(ends_at("1e-5"));
}

}  // namespace
}  // namespace plica
