#include "core/child_process.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <iostream>
#include <stdexcept>
#include <string_view>

#include "core/errors.hpp"

namespace plica {
namespace {

TEST(OutputOfChild, ComesBackWhole) {
  int cases = 0;
  for (const std::size_t size : {0U, 1U, 10'000'000U}) {
    const std::string sent(size, 'x');
    EXPECT_EQ(output_of_child("a test", [&] { return sent; }), sent);
    ++cases;
  }
  std::cout << cases << " sizes\n";
}

TEST(OutputOfChild, IsEmptyAfterACrash) {
  testing::internal::CaptureStderr();
  EXPECT_FALSE(output_of_child("a test", []() -> std::string { throw std::runtime_error("thrown"); }));
  EXPECT_FALSE(output_of_child("a test", []() -> std::string {
    std::signal(SIGABRT, SIG_DFL);
    std::abort();
  }));
  EXPECT_FALSE(output_of_child("a test", []() -> std::string {
    (void)std::raise(SIGKILL);
    return "unreached";
  }));
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(OutputOfChild, IsNotWaitedForWhenItStandsStill) {
  try {
    (void)output_of_child(
        "waiting for Godot",
        []() -> std::string {
          while (true) ::pause();
        },
        1.5);
    FAIL() << "came back";
  } catch (const FileError& error) {
    EXPECT_TRUE(std::string_view(error.what()).starts_with("waiting for Godot made no progress for 2 s"))
        << error.what();
  }
}

// Work takes as long as it takes.
TEST(OutputOfChild, IsWaitedForWhileItWorks) {
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(output_of_child(
                "a test",
                [&]() -> std::string {
                  while (std::chrono::steady_clock::now() - start < std::chrono::seconds(4)) {
                  }
                  return "done";
                },
                1.5),
            "done");
}

TEST(OutputOfChild, ChangesNothingHere) {
  int here = 1;
  EXPECT_EQ(output_of_child("a test", [&] { return std::to_string(++here); }), "2");
  EXPECT_EQ(here, 1);
}

}  // namespace
}  // namespace plica
