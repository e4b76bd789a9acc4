// Named arrays in an in-memory HDF5 file, the basis of checkpoints. Without HDF5, plica has no checkpoints.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace plica {

/// Whether this build has HDF5.
bool can_archive();

/// Writer of arrays to an in-memory file. Names are paths: "state/positions". An array replaces an earlier one of its
/// name; with equal length that costs only a copy. Throws FileError if HDF5 fails (no memory) or is missing; discard it
/// then.
class ArchiveWriter {
 public:
  ArchiveWriter();
  ~ArchiveWriter();
  ArchiveWriter(const ArchiveWriter&) = delete;
  ArchiveWriter& operator=(const ArchiveWriter&) = delete;

  /// Add an array. `columns`: 0 for a list, else the row length of a table.
  void put(const std::string& name, std::span<const double> values, std::size_t columns = 0);
  void put(const std::string& name, std::span<const int> values);
  void put(const std::string& name, std::span<const char> bytes);

  /// Bytes of the file. Equal arrays, each put once, give equal bytes.
  [[nodiscard]] std::string image();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// Reader of such a file. Throws FileError, without a path, for another file, an array that is missing or of another
/// type, or numbers that are not finite.
class ArchiveReader {
 public:
  explicit ArchiveReader(std::string_view image);
  ~ArchiveReader();
  ArchiveReader(const ArchiveReader&) = delete;
  ArchiveReader& operator=(const ArchiveReader&) = delete;

  [[nodiscard]] bool has(const std::string& name) const;
  [[nodiscard]] std::vector<double> doubles(const std::string& name) const;
  [[nodiscard]] std::vector<int> integers(const std::string& name) const;
  [[nodiscard]] std::vector<char> bytes(const std::string& name) const;

 private:
  struct File;
  std::unique_ptr<File> file_;
};

}  // namespace plica
