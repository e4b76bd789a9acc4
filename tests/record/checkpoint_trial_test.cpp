#include <gtest/gtest.h>

#include <csignal>
#include <new>

#include "core/errors.hpp"
#include "record/checkpoint.hpp"

namespace plica {
namespace {

// What the FileError says that comes out; nothing when none does.
std::string complaint(const std::function<void()>& read) {
  try {
    read_on_trial(read, 0);
    return "";
  } catch (const FileError& error) {
    return error.what();
  }
}

TEST(ReadingTrial, LetsErrorsOut) {
  EXPECT_EQ(complaint([] {}), "");
  EXPECT_EQ(complaint([] { throw FileError("it is damaged: a and b"); }), "it is damaged: a and b");
  EXPECT_THROW(read_on_trial([] { throw std::bad_alloc(); }, 0), std::bad_alloc);
}

TEST(ReadingTrial, OutlivesACrash) {
  EXPECT_EQ(complaint([] { (void)std::raise(SIGKILL); }), "it is damaged: HDF5 crashed while reading it");
}

// Three seconds of the processor's time: this test takes them.
TEST(ReadingTrial, OutlivesWhatNeverEnds) {
  const auto read = [] {
    volatile bool goes_on = true;
    while (goes_on) continue;
  };
  EXPECT_EQ(complaint(read), "it is damaged: HDF5 crashed while reading it");
}

}  // namespace
}  // namespace plica
