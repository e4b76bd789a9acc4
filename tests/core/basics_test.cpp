// Base64, diagnostics, memory, threads that share work, jobs in the background, output of child processes.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <iostream>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "core/background.hpp"
#include "core/base64.hpp"
#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "core/threads.hpp"

namespace plica {
namespace {

// The vectors of RFC 4648, section 10, and bytes above 127.
TEST(Base64, IsAsInTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\x89PNG\xff"), "iVBOR/8=");
}

TEST(Errors, ADiagnosticIsOneLineThatATerminalShows) {
  const Diagnostic diagnostic{"a\nb.toml", 3, "k\x1b[2J", "\"\xc2\x9b\x7f\" is wrong", "give \"µ\" or \"é\"\t"};
  EXPECT_EQ(diagnostic.text(), R"(a\nb.toml:3: k\u001B[2J: "\u009B\u007F" is wrong; give "µ" or "é"\u0009)");
  EXPECT_EQ(printable("plain, µm³ \xc2"), "plain, µm³ \\xC2");  // a byte that is no UTF-8
}

TEST(PeakMemory, GrowsWithWhatIsTakenAndStays) {
  const double before_MB = peak_memory_MB();
  EXPECT_GT(before_MB, 1);
  EXPECT_LT(before_MB, 1e5);
  const double much_MB = before_MB + 50;  // more than ever
  {
    std::vector<char> block(static_cast<std::size_t>(much_MB * 1e6), 1);
    EXPECT_EQ(block.back(), 1);
  }
  EXPECT_GE(peak_memory_MB(), much_MB);
}

TEST(Parallel, FindsTheFirstOnAnyThreads) {
  for (const int count : {1, 2, 4}) {
    const ThreadCount scope(count);
    for (const std::size_t first : {0U, 777U, 60'000U, 99'999U})
      EXPECT_EQ(parallel_find(100'000, [&](std::size_t i) { return i >= first && (i - first) % 1000 == 0; }), first);
    EXPECT_EQ(parallel_find(100'000, [](std::size_t) { return false; }), 100'000U);
    EXPECT_EQ(parallel_find(0, [](std::size_t) { return true; }), 0U);
  }
}

TEST(Parallel, SquaredNormIsThatOfAllVectorsAndTheSameBitsOnAnyThreads) {
  const Vectors vectors(50'001, Vec3(0.1, -0.2, 0.3));
  const auto on = [&](int threads) {
    const ThreadCount scope(threads);
    return parallel_squared_norm(vectors);
  };
  EXPECT_NEAR(on(1), 50'001 * 0.14, 1e-8);
  EXPECT_EQ(on(3), on(1));
}

// Out of a parallel region, where it would end the process: what one iteration throws.
TEST(Parallel, WhatAnIterationThrowsComesOut) {
  for (const int count : {1, 2, 4}) {
    const ThreadCount scope(count);
    EXPECT_THROW(parallel_for(50'000,
                              [](std::size_t i) {
                                if (i == 31'234) throw std::bad_alloc();
                              }),
                 std::bad_alloc);
    std::vector<int> times(50'000, 0);
    parallel_for(times.size(), [&](std::size_t i) { ++times[i]; });
    EXPECT_EQ(std::ranges::count(times, 1), 50'000) << "each once";
  }
}

/// A job that waits until the test lets it go on.
class Gate {
 public:
  void open() { is_open_ = true, is_open_.notify_all(); }
  void wait() { is_open_.wait(false); }

 private:
  std::atomic<bool> is_open_ = false;
};

template <class Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(Background, DoesJobsInTheirOrderOnAnotherThread) {
  std::vector<int> done;
  std::thread::id worker;
  Background background(3);
  for (int i = 0; i < 100; ++i)
    background.add([&, i] {
      worker = std::this_thread::get_id();
      done.push_back(i);
    });
  background.finish();
  ASSERT_EQ(done.size(), 100U);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(done[i], i);
  EXPECT_NE(worker, std::this_thread::get_id());
  EXPECT_GT(background.processor_s(), 0);
}

// In the midst of a job its thread may hold a lock, which a child process would find locked for ever.
TEST(Background, ChildProcessesStartBetweenJobs) {
  std::atomic<bool> is_at_work = false;
  Background background(50);
  for (int i = 0; i < 50; ++i)
    background.add([&] {
      is_at_work = true;
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      is_at_work = false;
    });
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(output_of_child("a test", [&] { return std::string(is_at_work ? "at work" : "at rest"); }), "at rest");
  background.finish();
}

TEST(Background, TakesNoMoreThanItMayHold) {
  Gate gate;
  std::atomic<int> taken = 0;
  Background background(2);
  background.add([&] { gate.wait(); });
  std::thread giver([&] {
    for (int i = 0; i < 10; ++i, ++taken) background.add([] {});
  });
  for (int i = 0; i < 50 && taken < 3; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  EXPECT_LE(taken, 3);  // two that wait, and one whose place the first job left while it was being done
  gate.open();
  giver.join();
  background.finish();
  EXPECT_EQ(taken, 10);
}

TEST(Background, AFaultIsToldOnceAndEndsTheWork) {
  const std::vector<std::function<void(Background&)>> tellers = {
      [](Background& b) { b.add([] {}); }, [](Background& b) { b.check(); }, [](Background& b) { b.finish(); }};
  for (const auto& tell : tellers) {
    Gate gate;
    std::atomic<int> later = 0;
    Background background(4);
    background.add([&] {
      gate.wait();
      throw std::runtime_error("the disk is full");
    });
    background.add([&] { ++later; });
    EXPECT_FALSE(background.has_failed());
    gate.open();
    while (!background.has_failed()) std::this_thread::yield();
    EXPECT_EQ(message_of([&] { tell(background); }), "the disk is full");
    EXPECT_FALSE(background.has_failed());
    background.check();
    background.add([&] { ++later; });
    background.finish();
    EXPECT_EQ(later, 0);
  }
}

TEST(Background, AFaultReachesWhoWaitsForAPlace) {
  Background background(1);
  std::string message;
  for (int i = 0; i < 1000 && message.empty(); ++i)
    message = message_of([&] { background.add([] { throw std::runtime_error("gone"); }); });
  EXPECT_EQ(message, "gone");
}

TEST(Background, WhatWaitsIsDoneBeforeItEnds) {
  int done = 0;
  {
    Background background(5);
    for (int i = 0; i < 5; ++i) background.add([&] { ++done; });
  }
  EXPECT_EQ(done, 5);
}

TEST(OutputOfChild, ComesBackWhole) {
  for (const std::size_t size : {0U, 1U, 10'000'000U}) {
    const std::string sent(size, 'x');
    EXPECT_EQ(output_of_child("a test", [&] { return sent; }), sent);
  }
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
