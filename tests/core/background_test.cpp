#include "core/background.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/child_process.hpp"

namespace plica {
namespace {

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
  int cases = 0;
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
    ++cases;
  }
  RecordProperty("cases", cases);
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

}  // namespace
}  // namespace plica
