// Lock that lets one process at a time write into a directory.
#pragma once

#include <filesystem>

namespace plica {

/// Lock of a directory, released by the destructor or, however the process ends, by the system. Does nothing if the
/// directory does not exist or its file system has no locks.
class DirectoryLock {
 public:
  /// Throws FileError if another process holds the lock.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace plica
