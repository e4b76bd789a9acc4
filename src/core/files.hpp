// Files that appear whole or not at all, and files that grow by whole rows. Whatever goes wrong (a full disk, a missing
// folder, no permission) is a FileError that says `PATH: cannot be written: REASON`, at the latest when the file is
// closed.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace plica {

/// Largest file that `read_file` takes.
inline constexpr std::uintmax_t largest_file_read_bytes = std::uintmax_t{256} << 20;

/// The content of a file. FileError when it cannot be read, is a directory, or is larger than `most_bytes`.
std::string read_file(const std::filesystem::path& path, std::uintmax_t most_bytes = largest_file_read_bytes);

/// Of all files in a directory and below; what cannot be seen counts nothing.
std::uintmax_t bytes_in(const std::filesystem::path& directory);

/// Writes a file whole or not at all: into a temporary file beside it, to the disk (fsync), then renamed. At any moment
/// `path` holds its former content or the new one. What is not a regular file (a pipe, a device) is written in place.
/// FileError when that fails; the temporary file is then removed.
void write_file(const std::filesystem::path& path, std::string_view content);

/// Whether a file is to be on the disk at once (fsync), or when the system comes to it: what is not outlives the
/// program, but not a power cut.
enum class Sync { now, later };

/// The two halves of write_file, for a file whose former content is to be kept under another name: a temporary file
/// beside `path`, and its rename.
std::filesystem::path write_beside(const std::filesystem::path& path, std::string_view content, Sync sync);
void rename_file(const std::filesystem::path& temporary, const std::filesystem::path& path, Sync sync);

/// A text file that grows by whole rows and can be read meanwhile.
class RowFile {
 public:
  /// Opens the file (creates it, without its folder) and cuts it back to its first `keep_bytes`: 0 starts anew, the
  /// `size_bytes()` of a checkpoint goes on from there. FileError also when the file is shorter than that, or when
  /// those bytes do not end with a whole row.
  explicit RowFile(std::filesystem::path path, std::uint64_t keep_bytes = 0);
  RowFile(RowFile&& other) noexcept;
  RowFile& operator=(RowFile&& other) noexcept;
  ~RowFile();

  /// Adds the row and '\n' in one write. Several rows, joined by '\n', are added together. FileError when the disk is
  /// full or the like; the file then still ends with the row before.
  void append(std::string_view row);

  /// Makes sure that what was appended is on the disk (fsync). FileError when it is not.
  void sync();

  [[nodiscard]] std::uint64_t size_bytes() const { return size_bytes_; }

 private:
  void close() noexcept;

  std::filesystem::path path_;
  int descriptor_ = -1;
  std::uint64_t size_bytes_ = 0;
};

}  // namespace plica
