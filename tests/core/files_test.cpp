#include "core/files.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <csignal>
#include <iostream>
#include <type_traits>

#include "core/errors.hpp"
#include "support/own_folder.hpp"

namespace plica {
namespace {

namespace fs = std::filesystem;

/// A folder of the test's own, removed at its end.
class FilesTest : public support::OwnFolder {
 protected:
  [[nodiscard]] std::size_t file_count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
  }
};

/// No file may grow beyond `bytes` as long as this lives: what a full disk looks like.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &former_);
    rlimit limit = former_;
    limit.rlim_cur = bytes;
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &former_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  rlimit former_{};
  void (*handler_)(int);
};

/// What `action` complains of; empty when it does not.
template <class Action>
std::string file_error(const Action& action) {
  try {
    action();
  } catch (const FileError& error) {
    return error.what();
  }
  return {};
}

TEST_F(FilesTest, WritesWhatItReads) {
  int cases = 0;
  for (const std::string& content :
       {std::string(), std::string("a\n"), std::string(1 << 20, 'x'), std::string("\0\r\n", 3)}) {
    write_file(folder / "file", content);
    EXPECT_EQ(read_file(folder / "file"), content);
    EXPECT_EQ(file_count(), 1U);
    ++cases;
  }
  std::cout << cases << " contents\n";
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
  EXPECT_EQ(file_error([&] { write_file(missing, "a"); }), missing + ": cannot be written: No such file or directory");
  EXPECT_EQ(file_error([&] { write_file(directory, "a"); }), directory + ": cannot be written: Is a directory");
  EXPECT_EQ(file_error([] { write_file("/dev/full", "a"); }), "/dev/full: cannot be written: No space left on device");
  EXPECT_TRUE(fs::is_character_file("/dev/full"));
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(FilesTest, AFullDiskLeavesTheFormerFile) {
  write_file(folder / "file", "former");
  const std::string content(100'000, 'x');
  std::string error;
  {
    const FileSizeLimit limit(50'000);
    error = file_error([&] { write_file(folder / "file", content); });
  }
  EXPECT_EQ(error, (folder / "file").string() + ": cannot be written: File too large");
  EXPECT_EQ(read_file(folder / "file"), "former");
  EXPECT_EQ(file_count(), 1U);
}

TEST_F(FilesTest, WhatCannotBeReadIsNamed) {
  const std::string missing = (folder / "none").string(), large = (folder / "large").string();
  EXPECT_EQ(file_error([&] { read_file(missing); }), missing + ": cannot be read: No such file or directory");
  EXPECT_EQ(file_error([&] { read_file(folder); }), folder.string() + ": cannot be read: Is a directory");
  write_file(large, "a");
  fs::resize_file(large, largest_file_read_bytes);
  EXPECT_EQ(read_file(large).size(), largest_file_read_bytes);
  fs::resize_file(large, largest_file_read_bytes + 1);
  EXPECT_EQ(file_error([&] { read_file(large); }), large + ": cannot be read: it is larger than 256 MiB");
  EXPECT_EQ(file_error([] { read_file("/dev/zero"); }), "/dev/zero: cannot be read: it is larger than 256 MiB");
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
  EXPECT_EQ(file_error([&] { RowFile(path, 7); }),
            path + ": cannot be written: it has 6 bytes, fewer than the 7 to continue from");
  EXPECT_EQ(file_error([&] { RowFile(path, 3); }),
            path + ": cannot be written: its first 3 bytes do not end with a complete row");
  EXPECT_EQ(read_file(path), "a\nb\nd\n");
  RowFile(path).append("anew");
  EXPECT_EQ(read_file(path), "anew\n");
}

TEST_F(FilesTest, RowsMoveAndDoNotCopy) {
  static_assert(!std::is_copy_constructible_v<RowFile> && std::is_nothrow_move_constructible_v<RowFile>);
  RowFile first(folder / "first"), second(folder / "second");
  first.append("a");
  RowFile moved(std::move(first));
  moved.append("b");
  second = std::move(moved);
  second.append("c");
  EXPECT_EQ(read_file(folder / "first"), "a\nb\nc\n");
  EXPECT_EQ(read_file(folder / "second"), "");
}

TEST_F(FilesTest, ARowThatDoesNotFitIsAnErrorAndIsCutOff) {
  RowFile full("/dev/full");
  EXPECT_EQ(file_error([&] { full.append("a"); }), "/dev/full: cannot be written: No space left on device");

  RowFile file(folder / "rows");
  const std::string row(39, 'x');
  int rows = 0;
  std::string error;
  {
    const FileSizeLimit limit(100);
    while (error.empty() && rows < 10) {
      error = file_error([&] { file.append(row); });
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
}  // namespace plica
