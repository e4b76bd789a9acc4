// Base64, diagnostics, memory, files, threads that share work, jobs in the background, output of child processes.
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <new>
#include <thread>
#include <type_traits>

#include "core/background.hpp"
#include "core/child_process.hpp"
#include "core/errors.hpp"
#include "core/files.hpp"
#include "core/markup.hpp"
#include "core/memory.hpp"
#include "core/parallel.hpp"
#include "core/threads.hpp"
#include "support/own_folder.hpp"

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

/// A job that waits until the test releases it.
class Gate {
 public:
  void open() { is_open_ = true, is_open_.notify_all(); }
  void wait() { is_open_.wait(false); }

 private:
  std::atomic<bool> is_open_ = false;
};

TEST(Background, DoesJobsInTheirOrderOnAnotherThread) {
  std::vector<int> done;
  std::thread::id worker;
  Background background;
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
  Background background;
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

TEST(Background, AFaultIsToldOnceAndEndsTheWork) {
  const std::vector<std::function<void(Background&)>> tellers = {[](Background& b) { b.add([] {}); },
                                                                 [](Background& b) { b.finish(); }};
  for (const auto& tell : tellers) {
    Gate gate;
    std::atomic<int> later = 0;
    Background background;
    background.add([&] {
      gate.wait();
      throw std::runtime_error("the disk is full");
    });
    background.add([&] { ++later; });
    EXPECT_FALSE(background.has_failed());
    gate.open();
    while (!background.has_failed()) std::this_thread::yield();
    EXPECT_EQ(error_of<std::runtime_error>([&] { tell(background); }), "the disk is full");
    EXPECT_FALSE(background.has_failed());
    background.add([&] { ++later; });
    background.finish();
    EXPECT_EQ(later, 0);
  }
}

TEST(Background, WhatWaitsIsDoneBeforeItEnds) {
  int done = 0;
  {
    Background background;
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
  const auto pause = []() -> std::string {
    while (true) ::pause();
  };
  const std::string said = error_of<FileError>([&] { return output_of_child("waiting for Godot", pause, 1.5); });
  EXPECT_TRUE(said.starts_with("waiting for Godot made no progress for 2 s")) << said;
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

namespace fs = std::filesystem;

/// A folder of the test's own, removed at its end.
class FilesTest : public OwnFolder {
 protected:
  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

TEST_F(FilesTest, WritesWhatItReads) {
  for (const std::string& content :
       {std::string(), std::string("a\n"), std::string(1 << 20, 'x'), std::string("\0\r\n", 3)}) {
    write_file(folder / "file", content);
    EXPECT_EQ(read_file(folder / "file"), content);
    EXPECT_EQ(file_count(), 1U);
  }
}

TEST_F(FilesTest, WritesWithTheUsualPermissions) {
  const mode_t mask = ::umask(022);
  write_file(folder / "file", "a");
  ::umask(mask);
  EXPECT_EQ(fs::status(folder / "file").permissions(), fs::perms(0644));
}

TEST_F(FilesTest, ALinkStaysALink) {
  write_file(folder / "file", "old");
  fs::create_symlink("file", folder / "link");
  write_file(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(read_file(folder / "file"), "new");
}

TEST_F(FilesTest, WhatCannotBeWrittenIsNamed) {
  fs::create_directory(folder / "folder");
  const std::string missing = (folder / "none" / "file").string(), directory = (folder / "folder").string();
  EXPECT_EQ(error_of<FileError>([&] { write_file(missing, "a"); }),
            missing + ": cannot be written: No such file or directory");
  EXPECT_EQ(error_of<FileError>([&] { write_file(directory, "a"); }),
            directory + ": cannot be written: Is a directory");
  EXPECT_EQ(error_of<FileError>([] { write_file("/dev/full", "a"); }),
            "/dev/full: cannot be written: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(FilesTest, AFullDiskLeavesTheFormerFile) {
  write_file(folder / "file", "former");
  const std::string content(100'000, 'x');
  std::string error;
  {
    const FileSizeLimit limit(50'000);
    error = error_of<FileError>([&] { write_file(folder / "file", content); });
  }
  EXPECT_EQ(error, (folder / "file").string() + ": cannot be written: File too large");
  EXPECT_EQ(read_file(folder / "file"), "former");
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(FilesTest, WhatCannotBeReadIsNamed) {
  const std::string missing = (folder / "none").string(), large = (folder / "large").string();
  EXPECT_EQ(error_of<FileError>([&] { read_file(missing); }), missing + ": cannot be read: No such file or directory");
  EXPECT_EQ(error_of<FileError>([&] { read_file(folder); }), folder.string() + ": cannot be read: Is a directory");
  write_file(large, "a");
  fs::resize_file(large, largest_file_read_bytes);
  EXPECT_EQ(read_file(large).size(), largest_file_read_bytes);
  fs::resize_file(large, largest_file_read_bytes + 1);
  EXPECT_EQ(error_of<FileError>([&] { read_file(large); }), large + ": cannot be read: it is larger than 256 MiB");
  EXPECT_EQ(error_of<FileError>([] { read_file("/dev/zero"); }),
            "/dev/zero: cannot be read: it is larger than 256 MiB");
}

TEST_F(FilesTest, RowsCanBeReadAtOnce) {
  RowFile file(folder / "rows");
  file.append("a,b");
  EXPECT_EQ(read_file(folder / "rows"), "a,b\n");
  file.append("1,2\n3,4");
  EXPECT_EQ(read_file(folder / "rows"), "a,b\n1,2\n3,4\n");
  EXPECT_EQ(file.size_bytes(), 12U);
  file.sync();
}

TEST_F(FilesTest, RowsGoOnWhereTheCheckpointWas) {
  {
    RowFile file(folder / "rows");
    for (const char* row : {"a", "b", "c"}) file.append(row);
  }
  {
    RowFile file(folder / "rows", 4);
    EXPECT_EQ(file.size_bytes(), 4U);
    file.append("d");
  }
  EXPECT_EQ(read_file(folder / "rows"), "a\nb\nd\n");
  const std::string path = (folder / "rows").string();
  EXPECT_EQ(error_of<FileError>([&] { RowFile(path, 7); }),
            path + ": cannot be written: it has 6 bytes, fewer than the 7 to continue from");
  EXPECT_EQ(error_of<FileError>([&] { RowFile(path, 3); }),
            path + ": cannot be written: its first 3 bytes do not end with a complete row");
  EXPECT_EQ(read_file(path), "a\nb\nd\n");
  RowFile(path).append("anew");
  EXPECT_EQ(read_file(path), "anew\n");
}

TEST_F(FilesTest, ARowThatDoesNotFitIsAnErrorAndIsCutOff) {
  RowFile full("/dev/full");
  EXPECT_EQ(error_of<FileError>([&] { full.append("a"); }), "/dev/full: cannot be written: No space left on device");

  RowFile file(folder / "rows");
  const std::string row(39, 'x');
  int rows = 0;
  std::string error;
  {
    const FileSizeLimit limit(100);
    while (error.empty() && rows < 10) {
      error = error_of<FileError>([&] { file.append(row); });
      if (error.empty()) ++rows;
    }
  }
  EXPECT_EQ(rows, 2);
  EXPECT_EQ(error, (folder / "rows").string() + ": cannot be written: File too large");
  EXPECT_EQ(read_file(folder / "rows"), row + "\n" + row + "\n");
  // The disk has room again.
  file.append("end");
  EXPECT_EQ(read_file(folder / "rows"), row + "\n" + row + "\nend\n");
}

}  // namespace
