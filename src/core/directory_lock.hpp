// One process at a time writes into a directory.
#pragma once

#include <filesystem>

namespace plica {

/// Holds a directory until it goes; the system lets go of it when the process ends, however it does. Where there is no
/// directory, or its file system has no locks, it holds nothing.
class DirectoryLock {
 public:
  /// FileError when another process holds it.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace plica
