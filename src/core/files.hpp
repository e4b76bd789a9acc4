// Files written atomically, files that grow by complete rows, and locks of directories. Any failure (full disk, missing
// folder, permission) throws FileError `PATH: cannot be written: REASON`, at the latest when the file is closed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace plica {

inline constexpr std::uintmax_t largest_file_read_bytes = std::uintmax_t{256} << 20;

/// Throw FileError `PATH: cannot be read: WHY`.
[[noreturn]] void throw_unread(const std::filesystem::path& path, const std::string& why);

/// Read a file. Throws FileError if it is unreadable, a directory, or larger than `most_bytes`.
std::string read_file(const std::filesystem::path& path, std::uintmax_t most_bytes = largest_file_read_bytes);

/// Whether a path exists; false if the system does not tell.
bool is_there(const std::filesystem::path& path);

/// Create a directory and those above it. Throws FileError `PATH: cannot be created: REASON`.
void make_directory(const std::filesystem::path& path);

/// Sum of the sizes of all files below a directory; unreadable ones count 0.
std::uintmax_t bytes_in(const std::filesystem::path& directory);

/// Write a file atomically: to a temporary file beside it, synced to disk (fsync), then renamed, so `path` always has
/// its former or its new content. A pipe or device is written in place. Throws FileError and removes the temporary
/// file.
void write_file(const std::filesystem::path& path, std::string_view content);

/// When a file is synced to disk: now (fsync), or later by the system. A later sync survives a crash of the program,
/// but not a power cut.
enum class Sync { now, later };

/// Steps of write_file (temporary file beside `path`, and its rename), for callers that keep the former content under
/// another name.
std::filesystem::path write_beside(const std::filesystem::path& path, std::string_view content, Sync sync);
void rename_file(const std::filesystem::path& temporary, const std::filesystem::path& path, Sync sync);

/// Text file that grows by complete rows and can be read meanwhile.
class RowFile {
 public:
  /// Open or create the file (not its folder) and truncate it to `keep_bytes`: 0, or the `size_bytes()` of a checkpoint
  /// to continue from. Throws FileError, also if the file is shorter or these bytes do not end with a complete row.
  explicit RowFile(std::filesystem::path path, std::uint64_t keep_bytes = 0);
  RowFile(const RowFile&) = delete;
  RowFile& operator=(const RowFile&) = delete;
  ~RowFile();

  /// Append the row (or several, joined by '\n') and '\n' in one write. Throws FileError, for example if the disk is
  /// full; the file then still ends with the previous row.
  void append(std::string_view row);

  /// Sync appended rows to disk (fsync). Throws FileError.
  void sync();

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }

 private:
  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_bytes_ = 0;
};

/// Lock that lets one process at a time write into a directory, released by the destructor or, however the process
/// ends, by the system. Does nothing if the directory does not exist or its file system has no locks.
class DirectoryLock {
 public:
  /// Throws FileError if another process holds the lock.
  explicit DirectoryLock(const std::filesystem::path& directory);
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;
  ~DirectoryLock();

 private:
  int descriptor_;
};

}  // namespace plica
