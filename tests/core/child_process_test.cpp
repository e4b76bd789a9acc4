#include "core/child_process.hpp"

#include <gtest/gtest.h>

#include <csignal>
#include <iostream>
#include <stdexcept>

namespace plica {
namespace {

TEST(OutputOfChild, ComesBackWhole) {
  int cases = 0;
  for (const std::size_t size : {0U, 1U, 10'000'000U}) {
    const std::string sent(size, 'x');
    EXPECT_EQ(output_of_child([&] { return sent; }), sent);
    ++cases;
  }
  std::cout << cases << " sizes\n";
}

TEST(OutputOfChild, IsEmptyAfterACrash) {
  testing::internal::CaptureStderr();
  EXPECT_FALSE(output_of_child([]() -> std::string { throw std::runtime_error("thrown"); }));
  EXPECT_FALSE(output_of_child([]() -> std::string {
    std::signal(SIGABRT, SIG_DFL);
    std::abort();
  }));
  EXPECT_FALSE(output_of_child([]() -> std::string {
    (void)std::raise(SIGKILL);
    return "unreached";
  }));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(OutputOfChild, ChangesNothingHere) {
  int here = 1;
  EXPECT_EQ(output_of_child([&] { return std::to_string(++here); }), "2");
  EXPECT_EQ(here, 1);
}

}  // namespace
}  // namespace plica
